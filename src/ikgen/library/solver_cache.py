"""Solvers that were made before, by what they were made from: one JSON file each.

The folder is `IKGEN_CACHE_DIR`, else the platform's for caches. Files appear whole (written beside, then
moved), and one that is broken, or of an other ikgen, is as good as none: a cache never fails a `load`.
"""

from __future__ import annotations

import hashlib
import json
import os
import sys
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ikgen.importers.named_robots import is_named
from ikgen.records.codec import encode

if TYPE_CHECKING:
    from ikgen.generation.generate import Made
    from ikgen.records.request import Outputs, Request
    from ikgen.verify.verification_report import VerificationReport

__all__ = ["SolverCache", "SolverEntry", "cache_folder"]


@dataclass(frozen=True, slots=True)
class SolverEntry:
    """One solver: the arm's `name`, the `text` of its Python module and its digest, what its verification
    found (none: it was not verified), and what a derivation has to be told to come out the same: tasks
    that were `passed_over`, choices of held joints that were `refused`. `warnings` are what
    `from-urdf` warns of."""

    name: str
    text: str
    sha256: str
    report: VerificationReport | None = None
    passed_over: tuple[str, ...] = ()
    refused: tuple[tuple[str, ...], ...] = ()
    warnings: tuple[str, ...] = ()
    card: str = ""

    @classmethod
    def of(cls, made: Made) -> SolverEntry:
        """The solver that was just made."""
        from ikgen.derivation.announcements import announcements
        from ikgen.library.arm_card import card

        derivation = made.derivation
        (text,) = made.texts["python"].values()
        return cls(
            derivation.module.name,
            text,
            hashlib.sha256(text.encode()).hexdigest(),
            made.reports.get("python"),
            made.passed_over,
            () if derivation.held is None else derivation.held.refused,
            announcements(derivation),
            card(derivation, made.reports.get("python")),
        )


@dataclass(frozen=True, slots=True)
class SolverCache:
    """The solvers in a folder, which need not be there."""

    folder: Path

    @classmethod
    def default(cls) -> SolverCache:
        """The cache of this user."""
        return cls(cache_folder() / "solvers")

    def key(self, request: Request, outputs: Outputs) -> str:
        """Digest of everything that a solver is made from: the description, the options, this ikgen."""
        told = {
            "ikgen": _fingerprint(),
            "robot": [request.robot.name, _content(request)],
            "calibration": _digest(request.calibration),
            "options": encode(request, lambda path: path.name),
            "units": [_units(request.free), _units(request.lock)],
            "verify": [outputs.verify, outputs.samples, outputs.seed],
        }
        return hashlib.sha256(json.dumps(told, sort_keys=True).encode()).hexdigest()

    def read(self, key: str) -> SolverEntry | None:
        """The solver of a key; None where there is none that is whole."""
        try:
            data = json.loads((self.folder / f"{key}.json").read_text(encoding="utf-8"))
            entry = _entry(data)
        except (OSError, ValueError, TypeError, LookupError, RecursionError):
            return None
        whole = hashlib.sha256(entry.text.encode()).hexdigest() == entry.sha256
        return entry if whole else None

    def write(self, key: str, entry: SolverEntry) -> None:
        """Keep a solver; where the folder cannot be written to it is not kept."""
        text = json.dumps(asdict(entry))
        with suppress(OSError):
            self.folder.mkdir(parents=True, exist_ok=True, mode=0o700)
            with tempfile.NamedTemporaryFile(
                "w", encoding="utf-8", dir=self.folder, suffix=".part", delete=False
            ) as stream:
                stream.write(text)
            try:
                Path(stream.name).replace(self.folder / f"{key}.json")
            except OSError:
                Path(stream.name).unlink(missing_ok=True)


def _entry(data: dict[str, Any]) -> SolverEntry:
    """The entry of what `asdict` made of it."""
    report, refused = data["report"], data["refused"]
    return SolverEntry(
        data["name"],
        data["text"],
        data["sha256"],
        None if report is None else _report(report),
        tuple(data["passed_over"]),
        tuple(tuple(names) for names in refused),
        tuple(data["warnings"]),
        data["card"],
    )


def _report(data: dict[str, Any]) -> VerificationReport:
    from ikgen.verify.verification_report import CheckResult, SigmaBand, VerificationReport

    pairs = {name: tuple(map(tuple, data[name])) for name in ("histogram", "locked")}
    checks = (CheckResult(**{**c, "worst": tuple(map(tuple, c["worst"]))}) for c in data["checks"])
    bands = (SigmaBand(**band) for band in data["bands"])
    more = {"checks": tuple(checks), "bands": tuple(bands), "notes": tuple(data["notes"])}
    return VerificationReport(**{**data, **pairs, **more, "by_default": tuple(data["by_default"])})


def cache_folder() -> Path:
    """Where ikgen keeps what can be made again."""
    own = os.environ.get("IKGEN_CACHE_DIR")
    if own:
        return Path(own)
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData/Local") / "ikgen"
    if sys.platform == "darwin":
        return Path.home() / "Library/Caches/ikgen"
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "ikgen"


def _digest(file: Path | None) -> str | None:
    return None if file is None else hashlib.sha256(file.read_bytes()).hexdigest()


def _units(values: Mapping[str, float | None]) -> list[str]:
    """The units that values came with, which a robot may refuse."""
    return [getattr(value, "unit", "") for value in values.values()]


def _content(request: Request) -> str:
    """Digest of the description: of a file that can take others in, after it did."""
    from ikgen.derivation.read import read_tree
    from ikgen.importers import importer_of

    if is_named(request.robot):
        return read_tree(request).source.sha256
    if request.table or importer_of(request.robot).self_contained:
        return str(_digest(request.robot))
    return read_tree(request).source.sha256


@cache
def _fingerprint() -> str:
    """Digest of this ikgen: of its version, and of its files, which say more where it is worked on."""
    from ikgen import __version__
    from ikgen.emit.rendering import template_folder

    digest = hashlib.sha256(__version__.encode())
    root = Path(__file__).resolve().parents[1]
    for path in _sources(root, template_folder("python")):
        digest.update(path.name.encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()


def _sources(*folders: Path) -> Iterator[Path]:
    for folder in folders:
        yield from sorted(
            path for path in folder.rglob("*") if path.suffix in (".py", ".jinja", ".hpp")
        )
