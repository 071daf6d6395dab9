"""The one family of errors that ikgen raises on bad input or an unsolved chain.

Every error has a message (what, and where in the file), a hint (a way out) and the exit code of the
command line (`docs/reference/exit-codes.md`).
"""

from __future__ import annotations

import difflib
import reprlib
from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import Any

__all__ = [
    "INTERNAL_ERROR",
    "ArgumentError",
    "BadDescriptionError",
    "IkgenError",
    "MissingToolError",
    "PlugInError",
    "UnknownNameError",
    "UnsolvedChainError",
    "UnsupportedJointError",
    "UsageError",
    "VerificationError",
    "place_in",
    "shown",
    "told",
]

INTERNAL_ERROR = 70
"""Exit code of a failure that is ikgen's own (EX_SOFTWARE of sysexits.h)."""

_MOST_LISTED = 100
_ALIKE = 0.5
"""From which ratio of `difflib` on names look alike."""

_SHORT = reprlib.Repr()
_SHORT.maxstring = _SHORT.maxother = _SHORT.maxlong = 60


def shown(value: object) -> str:
    """A value in a message: as Python writes it, cut where it is long."""
    return _SHORT.repr(value)


def place_in(file: str, line: int | None) -> str:
    """What a message about a place in a file begins with; "" where no file is known."""
    return "" if not file else f"{file}:{line}: " if line else f"{file}: "


class IkgenError(Exception):
    """Base of all errors meant for the user: message, hint, exit code, and `warnings` of what was noticed
    in the robot's file before."""

    exit_code = 2
    warnings: tuple[str, ...] = ()

    def __init__(self, message: str, *, hint: str = "") -> None:
        super().__init__(message)
        self.message = message
        self.hint = hint

    def __str__(self) -> str:
        """The message, and below it the way out: what a traceback shows."""
        return f"{self.message}\nhint: {self.hint}" if self.hint else self.message


class UsageError(IkgenError):
    """Options that do not fit together or lack a value."""


class ArgumentError(UsageError, ValueError):
    """An argument of a function of the library that does not do; the message names it."""


class BadDescriptionError(IkgenError):
    """A robot description, DH table or config that cannot be read; carries the file, the line and the
    problem without them."""

    def __init__(
        self, message: str, *, file: str = "", line: int | None = None, hint: str = ""
    ) -> None:
        super().__init__(f"{place_in(file, line)}{message}", hint=hint)
        self.problem = message
        self.file = file
        self.line = line


class UnknownNameError(IkgenError):
    """A link, joint, task or emitter that does not exist; lists what does, the closest
    matches first and else in the order of `known`."""

    def __init__(self, kind: str, name: str, known: Iterable[str], *, hint: str = "") -> None:
        names = list(known)
        close = _closest(name, names)
        rest = [n for n in names if n not in close]
        if len(names) > _MOST_LISTED:
            rest = [*rest[: _MOST_LISTED - len(close)], f"and {len(names) - _MOST_LISTED} more"]
        listing = ", ".join([*close, *rest]) or "none"
        super().__init__(f"no {kind} named '{name}'", hint=hint or f"there is: {listing}")
        self.name = name
        self.known = tuple(names)


def _closest(name: str, names: Iterable[str]) -> list[str]:
    """Up to three names that look like one, the most alike first; those alike keep their order, which
    `difflib.get_close_matches` turns round."""
    matcher = difflib.SequenceMatcher(b=name)
    scores: dict[str, float] = {}
    for one in names:
        matcher.set_seq1(one)
        if min(matcher.real_quick_ratio(), matcher.quick_ratio()) >= _ALIKE:
            scores[one] = matcher.ratio()
    alike = [one for one, score in scores.items() if score >= _ALIKE]
    return sorted(alike, key=lambda one: -scores[one])[:3]


class UnsupportedJointError(BadDescriptionError):
    """A joint inside the chain of a type that has no single axis (floating, planar, spherical)."""


class UnsolvedChainError(IkgenError):
    """No closed form found: the message says why, the hint what would help; `unsolved` is how far the
    derivation came (`ikgen.emit.derivation.Unsolved`), `details` say it in lines."""

    exit_code = 3

    def __init__(
        self,
        message: str,
        *,
        unsolved: Any = None,
        details: tuple[str, ...] = (),
        hint: str = "",
    ) -> None:
        super().__init__(message, hint=hint)
        self.unsolved = unsolved
        self.details = details


class MissingToolError(IkgenError):
    """An optional tool (compiler, Eigen, LaTeX) is needed and absent; the hint says how to get it."""


class PlugInError(IkgenError):
    """A part of another package that cannot be used; names the package and the entry point."""


class VerificationError(IkgenError):
    """Emitted code failed its verification; the message has the worst case's numbers, `reports` the
    whole of each language's verification, `derivation` is what was verified
    (`ikgen.emit.derivation.Derivation`)."""

    exit_code = 1

    def __init__(
        self,
        message: str,
        *,
        reports: Mapping[str, Any] = MappingProxyType({}),
        derivation: Any = None,
        hint: str = "",
    ) -> None:
        super().__init__(message, hint=hint)
        self.reports = reports
        self.derivation = derivation


def told(error: BaseException, *, traced: bool) -> tuple[str, str, int]:
    """Message, hint and exit code of what ended the work: an error for the user, one of the system about a
    file, or else a failure of ikgen's own; `traced`: its traceback is shown beside."""
    if isinstance(error, IkgenError):
        return error.message, error.hint, error.exit_code
    if isinstance(error, OSError):
        where = f"{error.filename}: " if error.filename else ""
        return f"{where}{error.strerror or error}", "check the path and its permissions", 2
    text = " ".join(str(error).split()) or "no message"
    hint = "please report it with the robot description, the command line and the config if any"
    hint += "" if traced else "; -v shows the traceback"
    return f"internal error: {type(error).__name__}: {text}", hint, INTERNAL_ERROR
