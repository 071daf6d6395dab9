"""What a report consists of, whatever it is printed to."""

from __future__ import annotations

from dataclasses import dataclass

from ikgen.formulas.mathtext import Math

__all__ = [
    "Block",
    "Card",
    "Fold",
    "Formulas",
    "Heading",
    "Inline",
    "Link",
    "Matrix",
    "Paragraph",
    "Picture",
    "Pictures",
    "Rows",
    "Text",
]


@dataclass(frozen=True, slots=True)
class Link:
    """Words that lead to an anchor of the document; plain words where there is no such anchor.
    `number` is that of the formula there, set by `numbered`."""

    words: str
    anchor: str
    number: int = 0


Inline = str | Math | Link
Text = tuple[Inline, ...]


@dataclass(frozen=True, slots=True)
class Heading:
    """A section's (level 1) or a step's (level 2) title; `anchor` is its place for links."""

    title: Text
    level: int = 1
    anchor: str = ""


@dataclass(frozen=True, slots=True)
class Paragraph:
    """Running text; `note` for an aside in smaller type."""

    text: Text
    note: bool = False


@dataclass(frozen=True, slots=True)
class Formulas:
    """Displayed formulas, one a line; each may break where it is too long. `anchors`: the places of the
    lines for links, as many as lines or none. `numbers` of the lines are set by `numbered`."""

    lines: tuple[Math, ...]
    anchors: tuple[str, ...] = ()
    numbers: tuple[int, ...] = ()


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
    """A drawing in both languages; without LaTeX it is left out there."""

    svg: str
    latex: str = ""
    caption: str = ""


@dataclass(frozen=True, slots=True)
class Pictures:
    """Small drawings side by side, each with what stands below it."""

    drawings: tuple[Picture, ...]


@dataclass(frozen=True, slots=True)
class Card:
    """What there is to know at a glance: pairs of a name and its text, beside a drawing."""

    picture: Picture
    facts: tuple[tuple[str, Text], ...]


@dataclass(frozen=True, slots=True)
class Fold:
    """Blocks behind a line of words, that the reader opens; on paper they just follow."""

    words: str
    blocks: tuple[Block, ...]


Block = Heading | Paragraph | Formulas | Matrix | Rows | Picture | Pictures | Card | Fold
"""One part of a document after the other."""
