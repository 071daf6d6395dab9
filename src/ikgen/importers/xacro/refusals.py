"""What an expansion is refused for: expressions, files and amounts."""

from __future__ import annotations

from pathlib import Path

__all__ = [
    "ExpansionLimitError",
    "RefusedExpressionError",
    "RefusedFileError",
]


class RefusedExpressionError(Exception):
    """An expression that does what descriptions have no business to do; the message says what, and
    `expression` is its text."""

    def __init__(self, message: str) -> None:
        super().__init__(message)
        self.expression = ""


class ExpansionLimitError(Exception):
    """An expansion that takes too long or grows too large; the message says which."""


class RefusedFileError(Exception):
    """A file outside the package of the description."""

    def __init__(self, path: Path) -> None:
        super().__init__(f"'{path}' lies outside the package of the description")
        self.path = path
