"""Import statements as data, and merged again as the head of a module."""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

__all__ = ["External", "import_lines"]

_WIDTH = 100


@dataclass(frozen=True, slots=True, order=True)
class External:
    """`import module as alias` (no `name`), or `from module import name as alias`."""

    module: str
    name: str
    alias: str

    @staticmethod
    def of(node: ast.Import | ast.ImportFrom) -> Iterator[External]:
        """What a statement imports, one each."""
        for part in node.names:
            if isinstance(node, ast.Import):
                yield External(part.name, "", part.asname or "")
            else:
                module = "." * node.level + (node.module or "")
                yield External(module, part.name, part.asname or "")

    @property
    def binds(self) -> str:
        """The name that it defines."""
        return self.alias or self.name or self.module.partition(".")[0]


def import_lines(imports: Iterable[External]) -> list[str]:
    """Lines of all imports, merged and sorted: those of the future, the standard library, others,
    the package's own."""
    unique = sorted(set(imports))
    groups: list[list[External]] = [[], [], [], []]
    for one in unique:
        top = one.module.partition(".")[0]
        if not top:
            groups[3].append(one)
            continue
        groups[0 if top == "__future__" else 1 if top in sys.stdlib_module_names else 2].append(one)
    lines: list[str] = []
    for group in groups:
        if group:
            lines += [""] * bool(lines) + list(_group_lines(group))
    return lines


def _group_lines(group: list[External]) -> Iterator[str]:
    for one in group:
        if not one.name:
            yield f"import {one.module}" + (f" as {one.alias}" if one.alias else "")
    for module in sorted({one.module for one in group if one.name}):
        names = sorted(
            (one for one in group if one.module == module and one.name),
            key=lambda one: (not one.name.isupper(), not one.name[:1].isupper(), one.name),
        )
        parts = [one.name + (f" as {one.alias}" if one.alias else "") for one in names]
        line = f"from {module} import {', '.join(parts)}"
        if len(line) <= _WIDTH:
            yield line
        else:
            yield f"from {module} import ("
            yield from (f"    {part}," for part in parts)
            yield ")"
