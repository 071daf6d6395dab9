"""Runners of several outputs, the next made while one is used: headers compile meanwhile."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from contextlib import ExitStack
from types import TracebackType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ikgen.verify.runners.runner import Runner

__all__ = ["Make", "RunnersAhead"]

Make = Callable[[], "Runner | None"]
"""Makes the runner of an output; None where it cannot be run."""

_AT_ONCE = 2
"""How many are made together, the one to be taken among them: each may be a compiler at work."""


class RunnersAhead:
    """The runners that `makes` give, to be taken in turn; at the end of the `with` they are closed, those
    too that were not taken. Of the first ones, which are made together, that of place `before` is made
    before the others: a compiler, say, that works meanwhile."""

    def __init__(self, makes: Iterable[Make], before: int = 0) -> None:
        self._makes = dict(enumerate(makes))
        self._made: dict[int, Runner | Exception | None] = {}
        self._taken, self._before = 0, before
        self._close = ExitStack()

    def __enter__(self) -> RunnersAhead:
        with ExitStack() as started:
            started.push(self.__exit__)  # of an interrupt
            self._make()
            started.pop_all()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._close.close()

    def take(self) -> Runner | None:
        """The next one, ready to be used. Raises here what making it raised, whenever that was: an output
        before it is told first."""
        self._make()
        made = self._made.pop(self._taken)
        self._taken += 1
        if isinstance(made, Exception):
            raise made
        if made is not None:
            _ = made.constants  # which waits for what is still compiled
        return made

    def _make(self) -> None:
        soon = range(self._taken, self._taken + _AT_ONCE)
        for place in sorted(soon, key=lambda place: place != self._before):
            make = self._makes.pop(place, None)
            if make is None:
                continue
            made: Runner | Exception | None
            try:
                made = make()
            except Exception as error:
                made = error
            self._made[place] = made
            if callable(close := getattr(made, "close", None)):
                self._close.callback(close)
