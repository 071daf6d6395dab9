"""A module of Python text taken apart: its definitions, and what each of them needs."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

from ikgen.emit.python.import_lines import External

__all__ = ["PACKAGE", "Definition", "RuntimeSource", "read_source", "taken_apart"]

PACKAGE = "ikgen.runtime.python"


@dataclass(frozen=True, slots=True)
class Definition:
    """A top-level statement: the names it `defines`; its `lines` from the comments above it on, the
    first being line `start` of the module; `places` of names in them (line from 0, column in
    bytes, name); whether it is a `block`, a function or class; the lines (first, last, from 0) that
    docstrings have behind their first paragraph as its `details`."""

    defines: tuple[str, ...]
    lines: tuple[str, ...]
    start: int
    places: tuple[tuple[int, int, str], ...]
    block: bool
    details: tuple[tuple[int, int], ...] = ()

    @property
    def uses(self) -> frozenset[str]:
        """Names that stand in it."""
        return frozenset(name for _, _, name in self.places)

    def text(self, names: Mapping[str, str]) -> str:
        """Its text with names replaced, in backticks of its documentation too; without details where
        no name of it is public: those are for who works on the runtime."""
        lines = [line.encode() for line in self.lines]
        for line, column, name in sorted(self.places, reverse=True):
            end = column + len(name.encode())
            new = names.get(name, name).encode()
            lines[line] = lines[line][:column] + new + lines[line][end:]
        if all(names.get(name, name).startswith("_") for name in self.defines):
            for first, last in reversed(self.details):
                lines[first - 1 : last + 1] = [lines[first - 1] + b'"""']
        text = b"\n".join(lines).decode()
        return re.sub(r"`(\w+)`", lambda m: f"`{names.get(m[1], m[1])}`", text)


@dataclass(frozen=True, slots=True)
class RuntimeSource:
    """`internal`: name -> (module, name there) of what it imports of the runtime; `external`: what it
    imports else; `imports`: the lines (first, last, from 1) from its first import to its last."""

    name: str
    docstring: str
    definitions: tuple[Definition, ...]
    internal: Mapping[str, tuple[str, str]]
    external: tuple[External, ...]
    imports: tuple[int, int]


@cache
def read_source(name: str) -> RuntimeSource:
    """The runtime's module of a name."""
    return taken_apart(name, (files(PACKAGE) / f"{name}.py").read_text(encoding="utf-8"))


def taken_apart(name: str, text: str, *, moved: bool = True) -> RuntimeSource:
    """A module from its text.

    Raises ValueError for what cannot be `moved` into another module: statements that define nothing, and
    local names that are the module's too.
    """
    tree, lines = ast.parse(text), text.splitlines()
    internal: dict[str, tuple[str, str]] = {}
    external: list[External] = []
    definitions: list[Definition] = []
    imports: list[int] = []
    parts: dict[ast.stmt, list[ast.AST]] = {}
    above = 0
    for node in tree.body:
        if isinstance(node, ast.Import | ast.ImportFrom):
            imports += [node.lineno, node.end_lineno or node.lineno]
            for one in External.of(node):
                if one.module.startswith(f"{PACKAGE}."):
                    internal[one.binds] = (one.module.removeprefix(f"{PACKAGE}."), one.name)
                else:
                    external.append(one)
        elif not _is_about_the_module(node):
            parts[node] = list(ast.walk(node))
            definitions.append(_definition(node, parts[node], lines, above))
            if moved and not definitions[-1].defines:
                raise ValueError(f"{name}, line {node.lineno}: only definitions can be bundled")
        above = node.end_lineno or node.lineno
    own = {n for d in definitions for n in d.defines} | set(internal)
    for node in parts if moved else ():
        shadows = sorted(set(_locals(node, parts[node])) & own)
        if shadows:
            raise ValueError(f"{name}, line {node.lineno}: local names of the module: {shadows}")
    span = (min(imports), max(imports)) if imports else (0, 0)
    docstring = ast.get_docstring(tree) or ""
    return RuntimeSource(name, docstring, tuple(definitions), internal, tuple(external), span)


def _is_about_the_module(node: ast.stmt) -> bool:
    if isinstance(node, ast.Assign):
        return isinstance(node.targets[0], ast.Name) and node.targets[0].id == "__all__"
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)


def _definition(node: ast.stmt, parts: list[ast.AST], lines: list[str], above: int) -> Definition:
    block = isinstance(node, ast.FunctionDef | ast.ClassDef)
    start = node.lineno
    if isinstance(node, ast.FunctionDef | ast.ClassDef):
        start = min([start, *(d.lineno for d in node.decorator_list)])
    while start - 1 > above and lines[start - 2].startswith("#"):
        start -= 1
    places = tuple((line - start, column, name) for line, column, name in _places(node, parts))
    part = tuple(lines[start - 1 : node.end_lineno])
    details = tuple((a - start, b - start) for a, b in _details(parts, lines))
    return Definition(_defined(node), part, start, places, block, details)


def _details(parts: list[ast.AST], lines: list[str]) -> Iterator[tuple[int, int]]:
    """First and last line (from 1) of what docstrings say behind their first paragraph, in order."""
    for part in parts:
        if isinstance(part, ast.FunctionDef | ast.ClassDef) and ast.get_docstring(part):
            first, last = part.body[0].lineno, part.body[0].end_lineno or part.body[0].lineno
            blank = next((i for i in range(first, last) if not lines[i - 1].strip()), None)
            if blank is not None:
                yield blank, last


def _defined(node: ast.stmt) -> tuple[str, ...]:
    """The names that a statement defines; none where it does something else as well."""
    if isinstance(node, ast.FunctionDef | ast.ClassDef):
        return (node.name,)
    targets: list[ast.expr] = []
    if isinstance(node, ast.Assign):
        targets = node.targets
    elif isinstance(node, ast.AnnAssign):
        targets = [node.target]
    parts = [e for t in targets for e in (t.elts if isinstance(t, ast.Tuple) else [t])]
    names = [part.id for part in parts if isinstance(part, ast.Name)]
    return tuple(names) if len(names) == len(parts) else ()


def _places(node: ast.stmt, parts: list[ast.AST]) -> Iterator[tuple[int, int, str]]:
    if isinstance(node, ast.FunctionDef | ast.ClassDef):
        yield node.lineno, len("def " if isinstance(node, ast.FunctionDef) else "class "), node.name
    for part in parts:
        if isinstance(part, ast.Name):
            yield part.lineno, part.col_offset, part.id


def _locals(node: ast.stmt, parts: list[ast.AST]) -> Iterator[str]:
    """Names that are bound inside a function or class."""
    if isinstance(node, ast.FunctionDef | ast.ClassDef):
        for part in parts:
            if isinstance(part, ast.arg):
                yield part.arg
            elif isinstance(part, ast.Name) and isinstance(part.ctx, ast.Store):
                yield part.id
            elif isinstance(part, ast.FunctionDef) and part is not node:
                yield part.name
