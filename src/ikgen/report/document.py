"""What a report consists of, whatever it is printed to."""

from __future__ import annotations

from dataclasses import dataclass

from ikgen.formulas.mathtext import Math

__all__ = [
    "Block",
    "Formulas",
    "Heading",
    "Inline",
    "Matrix",
    "Paragraph",
    "Picture",
    "Rows",
    "Text",
]

Inline = str | Math
Text = tuple[Inline, ...]


@dataclass(frozen=True, slots=True)
class Heading:
    """A section's (level 1) or a step's (level 2) title."""

    title: Text
    level: int = 1


@dataclass(frozen=True, slots=True)
class Paragraph:
    """Running text; `note` for an aside in smaller type."""

    text: Text
    note: bool = False


@dataclass(frozen=True, slots=True)
class Formulas:
    """Displayed formulas, one a line; each may break where it is too long. `lead` stands before."""

    lines: tuple[Math, ...]


@dataclass(frozen=True, slots=True)
class Matrix:
    """`name = [entries]`, small entries only."""

    name: Math
    rows: tuple[tuple[Math, ...], ...]


@dataclass(frozen=True, slots=True)
class Rows:
    """A table. `caption` says what it shows; `small` for one with many columns; `left` how many
    of its first columns are aligned left."""

    header: tuple[Text, ...]
    rows: tuple[tuple[Text, ...], ...]
    caption: str = ""
    small: bool = False
    left: int = 0


@dataclass(frozen=True, slots=True)
class Picture:
    """A drawing in both languages."""

    svg: str
    latex: str
    caption: str = ""


Block = Heading | Paragraph | Formulas | Matrix | Rows | Picture
