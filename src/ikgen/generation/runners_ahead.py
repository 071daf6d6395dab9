"""Runners of several outputs, the next made while one is used: headers compile meanwhile."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack
from types import TracebackType
from typing import Any

__all__ = ["Make", "RunnersAhead"]

Make = Callable[[], Any | None]
"""Makes the runner of an output; None where it cannot be run."""

_AT_ONCE = 2
"""How many are made together, the one to be taken among them: each may be a compiler at work."""


class RunnersAhead:
    """The runners that `makes` give, to be taken in turn; at the end of the `with` they are closed, those
    too that were not taken."""

    def __init__(self, makes: Iterable[Make]) -> None:
        self._makes: Iterator[Make] = iter(makes)
        self._made: deque[Any | Exception | None] = deque()
        self._close = ExitStack()

    def __enter__(self) -> RunnersAhead:
        self._make()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._close.close()

    def take(self) -> Any | None:
        """The next one, ready to be used. Raises here what making it raised, whenever that was: an output
        before it is told first."""
        self._make()
        made = self._made.popleft()
        if isinstance(made, Exception):
            raise made
        if made is not None:
            _ = made.constants  # which waits for what is still compiled
        return made

    def _make(self) -> None:
        while len(self._made) < _AT_ONCE and (make := next(self._makes, None)) is not None:
            try:
                made = make()
            except Exception as error:
                made = error
            self._made.append(made)
            if callable(close := getattr(made, "close", None)):
                self._close.callback(close)
