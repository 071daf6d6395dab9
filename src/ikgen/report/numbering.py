"""Numbers for all displayed formulas, and links that lead to those that are displayed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from ikgen.report.document import (
    Block,
    Card,
    Fold,
    Formulas,
    Heading,
    Inline,
    Link,
    Paragraph,
    Rows,
    Text,
)

__all__ = ["numbered"]


def numbered(blocks: Sequence[Block]) -> list[Block]:
    """The blocks with their formulas numbered from 1; the first formula of an anchor has it, and a link
    to an anchor that is nowhere becomes its words."""
    return _Numbering(blocks).all(blocks)


def _flat(blocks: Sequence[Block]) -> Iterator[Block]:
    for block in blocks:
        yield block
        if isinstance(block, Fold):
            yield from _flat(block.blocks)


class _Numbering:
    """One document's numbers: `_place` is the number of an anchor's formula, 0 of a heading's."""

    def __init__(self, blocks: Sequence[Block]) -> None:
        self._place: dict[str, int] = {}
        self._next = 1
        count = 0
        for block in _flat(blocks):
            if isinstance(block, Heading) and block.anchor:
                self._place.setdefault(block.anchor, 0)
            elif isinstance(block, Formulas):
                for i in range(len(block.lines)):
                    count += 1
                    if block.anchors and block.anchors[i]:
                        self._place.setdefault(block.anchors[i], count)

    def all(self, blocks: Sequence[Block]) -> list[Block]:
        return [self._block(block) for block in blocks]

    def _block(self, block: Block) -> Block:
        match block:
            case Formulas():
                return self._formulas(block)
            case Fold():
                return replace(block, blocks=tuple(self.all(block.blocks)))
            case Paragraph():
                return replace(block, text=self._text(block.text))
            case Card():
                return replace(block, facts=tuple((n, self._text(t)) for n, t in block.facts))
            case Rows():
                rows = tuple(tuple(self._text(cell) for cell in row) for row in block.rows)
                return replace(block, rows=rows)
            case _:
                return block

    def _formulas(self, block: Formulas) -> Formulas:
        numbers = tuple(range(self._next, self._next + len(block.lines)))
        self._next += len(block.lines)
        given = block.anchors or ("",) * len(block.lines)
        first = [a if self._place.get(a) == n else "" for a, n in zip(given, numbers, strict=True)]
        return replace(block, anchors=tuple(first), numbers=numbers)

    def _text(self, text: Text) -> Text:
        return tuple(self._inline(part) for part in text)

    def _inline(self, part: Inline) -> Inline:
        if not isinstance(part, Link):
            return part
        if part.anchor not in self._place:
            return part.words
        return replace(part, number=self._place[part.anchor])
