"""What verifications of one arm have in common, whatever the language: computed by the first of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

__all__ = ["SharedWork"]

_T = TypeVar("_T")


class SharedWork:
    """Things by name, of one arm with one task, number of samples and seed. Of the code under test there
    are answers alone, under its runner, for another to be compared with."""

    def __init__(self) -> None:
        self._known: dict[object, Any] = {}

    def once(self, name: object, compute: Callable[[], _T]) -> _T:
        """What `compute` gave when it was called for that name first."""
        if name not in self._known:
            self._known[name] = compute()
        known: _T = self._known[name]
        return known
