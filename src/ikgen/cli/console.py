"""What the user sees while a job runs: a status line on a terminal, plain lines elsewhere."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Iterable
from types import TracebackType
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from rich.status import Status

    from ikgen.derivation.progress import Stage

__all__ = ["Console"]

_WORDS: dict[Stage, str] = {
    "build": "checking",
    "read": "reading",
    "derive": "deriving",
    "try": "trying",
    "emit": "writing",
    "typeset": "typesetting",
    "verify": "verifying",
    "prove": "proving",
    "compile": "compiling",
    "map": "mapping",
}

_BAR = 30
"""Characters of a bar."""


class Console:
    """Progress on stderr, as a context manager; call it with a stage and a detail.

    On a terminal a status line; plain lines, one a stage, where stderr is no terminal or CI is set;
    nothing with `quiet`. `verbose` prints every detail as a line.
    """

    def __init__(self, *, quiet: bool = False, verbose: bool = False) -> None:
        self.quiet = quiet
        self.verbose = verbose and not quiet
        self._stage = ""
        self._status: Status | None = None
        self._shared = ("", 0.0)
        ci = os.environ.get("CI", "").lower() in ("1", "true", "yes")
        self._live = sys.stderr.isatty() and not (quiet or verbose or ci)

    def __enter__(self) -> Console:
        if self._live:
            try:
                from rich.console import Console as RichConsole
            except ImportError:  # an extra: plain lines do as well
                return self
            self._status = RichConsole(stderr=True).status("starting")
            self._status.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._status is not None:
            self._status.stop()
            self._status = None

    def __call__(self, stage: Stage, detail: str) -> None:
        """Say what happens now."""
        if self.quiet:
            return
        text = _words(stage, detail)
        if self._status is not None:
            from rich.markup import escape

            self._status.update(escape(text))
        elif self.verbose or stage != self._stage:
            click.echo(text if stage != "verify" or self.verbose else _WORDS["verify"], err=True)
        self._stage = stage

    def tell(self, name: str, steps: Iterable[tuple[Stage, str]], work: str) -> None:
        """With `verbose`: the steps of a job elsewhere and how it went, after its name."""
        if not self.verbose:
            return
        lines = [_words(stage, detail) for stage, detail in steps] + work.splitlines()
        for line in lines:
            click.echo(f"{name}: {line}".rstrip(), err=True)

    def share(self, stage: Stage, ready: int, total: int) -> None:
        """How much of a long stage is done: on a terminal as a bar with the time left, elsewhere not."""
        if self._status is None:
            return
        now = time.monotonic()
        if stage != self._shared[0]:
            self._shared = (stage, now)
        part = ready / max(total, 1)
        left = (now - self._shared[1]) * (1 - part) / part if part > 0 else 0.0
        whole = round(part * _BAR)
        bar = f"[green]{'━' * whole}[/green]{'─' * (_BAR - whole)}"
        self._status.update(f"{_WORDS[stage]} {bar} {100 * part:.0f} %, {left:.0f} s left")

    def note(self, text: str) -> None:
        """Something to know, shown unless quiet."""
        if not self.quiet:
            click.echo(text, err=True)

    def warn(self, text: str) -> None:
        """A warning, shown unless quiet."""
        if not self.quiet:
            click.echo(f"warning: {text}", err=True)


def _words(stage: Stage, detail: str) -> str:
    """What happens, in words."""
    return f"{_WORDS[stage]} {detail}".rstrip()
