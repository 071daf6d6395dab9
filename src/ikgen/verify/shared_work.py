"""What verifications of one arm have in common, whatever the language: computed by the first of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

__all__ = ["SharedWork"]

_T = TypeVar("_T")


class SharedWork:
    """Things by name, of one arm with one task, number of samples and seed; nothing of the code under test
    is among them."""

    def __init__(self) -> None:
        self._known: dict[str, Any] = {}

    def once(self, name: str, compute: Callable[[], _T]) -> _T:
        """What `compute` gave when it was called for that name first."""
        if name not in self._known:
            self._known[name] = compute()
        known: _T = self._known[name]
        return known
