"""Text from robot files in emitted Python: as a string literal, and as words of a docstring."""

from __future__ import annotations

__all__ = ["literal", "words"]


def literal(text: str) -> str:
    """The text as a Python string literal, in the quotes that need fewer escapes."""
    quote = "'" if text.count('"') > text.count("'") else '"'
    return f"{quote}{_escaped(text, quote)}{quote}"


def words(text: str) -> str:
    """The text inside a docstring of three double quotes."""
    return _escaped(text, '"')


def _escaped(text: str, quote: str) -> str:
    return "".join(_character(ch, quote) for ch in text)


def _character(ch: str, quote: str) -> str:
    """What cannot be printed (controls, surrogates, marks that turn the direction) becomes a number."""
    if ch in ("\\", quote):
        return f"\\{ch}"
    return ch if ch.isprintable() else ch.encode("unicode_escape").decode("ascii")
