"""A module of Python text taken apart: its definitions, and what each of them needs."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cache
from importlib.resources import files

from ikgen.emit.python.docstrings import Docstring, docstrings
from ikgen.emit.python.import_lines import External
from ikgen.emit.python.settled_branches import Facts, facts_in, settled

__all__ = ["PACKAGE", "Definition", "Member", "RuntimeSource", "read_source", "taken_apart"]

PACKAGE = "ikgen.runtime.python"


@dataclass(frozen=True, slots=True)
class Member:
    """A method of a class: its `name` and lines (first, last, from 0), from the comments and the empty line
    above it on."""

    name: str
    first: int
    last: int


@dataclass(frozen=True, slots=True)
class Definition:
    """A top-level statement: the names it `defines`; its `lines` from the comments above it on, the
    first being line `start` of the module; `places` of names in them (line from 0, column in
    bytes, name); names behind a dot as `attributes` (line from 0, name); whether it is a `block`, a
    function or class; its `docstrings` that have a summary; the `members` of a class that nothing but
    their names leads to."""

    defines: tuple[str, ...]
    lines: tuple[str, ...]
    start: int
    places: tuple[tuple[int, int, str], ...]
    attributes: tuple[tuple[int, str], ...]
    block: bool
    docstrings: tuple[Docstring, ...] = ()
    members: tuple[Member, ...] = ()

    @property
    def uses(self) -> frozenset[str]:
        """Names that stand in it."""
        return frozenset(name for _, _, name in self.places)

    def private(self, names: Mapping[str, str]) -> bool:
        """Whether none of its names is public."""
        return all(names.get(name, name).startswith("_") for name in self.defines)

    def without(self, members: Iterable[Member]) -> Definition:
        """The definition without some of its members: their lines are empty, and left out of its text."""
        gone = {k for one in members for k in range(one.first, one.last + 1)}
        return replace(
            self,
            lines=tuple("\0" if k in gone else line for k, line in enumerate(self.lines)),
            places=tuple(one for one in self.places if one[0] not in gone),
            attributes=tuple(one for one in self.attributes if one[0] not in gone),
            docstrings=tuple(one for one in self.docstrings if one.first not in gone),
            members=tuple(one for one in self.members if one.first not in gone),
        )

    def text(self, names: Mapping[str, str]) -> str:
        """Its text with names replaced, in backticks of its documentation too; where no name of it is
        public its docstrings say what they say first: the rest is for who works on the runtime."""
        lines = [line.encode() for line in self.lines]
        for line, column, name in sorted(self.places, reverse=True):
            end = column + len(name.encode())
            new = names.get(name, name).encode()
            lines[line] = lines[line][:column] + new + lines[line][end:]
        if self.private(names):
            for one in reversed(self.docstrings):
                lines[one.first : one.last + 1] = [line.encode() for line in one.summary]
        text = b"\n".join(line for line in lines if line != b"\0").decode()
        return re.sub(r"`(\w+)`", lambda m: f"`{names.get(m[1], m[1])}`", text)


@dataclass(frozen=True, slots=True)
class RuntimeSource:
    """`name`: `folder.module`; `defining`: name -> its definition; `internal`: name -> (module, name there)
    of what it imports of the runtime; `external`: what it imports else; `imports`: the lines (first, last,
    from 1) from its first import to its last."""

    name: str
    docstring: str
    definitions: tuple[Definition, ...]
    defining: Mapping[str, Definition]
    internal: Mapping[str, tuple[str, str]]
    external: tuple[External, ...]
    imports: tuple[int, int]


@cache
def read_source(name: str, facts: Facts = ()) -> RuntimeSource:
    """The runtime's `folder.module`, without what an arm of which `facts` are known never reaches."""
    return _source(name, facts_in(_text(name), facts))


@cache
def _text(name: str) -> str:
    return (files(PACKAGE) / f"{name.replace('.', '/')}.py").read_text(encoding="utf-8")


@cache
def _source(name: str, facts: Facts) -> RuntimeSource:
    left = settled(_text(name), facts)
    return _source(name, ()) if facts and left == _text(name) else taken_apart(name, left)


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
    defining = {n: d for d in definitions for n in d.defines}
    own = {*defining, *internal}
    for node in parts if moved else ():
        shadows = sorted(set(_locals(node, parts[node])) & own)
        if shadows:
            raise ValueError(f"{name}, line {node.lineno}: local names of the module: {shadows}")
    span = (min(imports), max(imports)) if imports else (0, 0)
    docstring = ast.get_docstring(tree) or ""
    made = tuple(definitions)
    return RuntimeSource(name, docstring, made, defining, internal, tuple(external), span)


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
    return Definition(
        _defined(node),
        tuple(lines[start - 1 : node.end_lineno]),
        start,
        tuple((line - start, column, name) for line, column, name in _places(node, parts)),
        tuple(
            (part.lineno - start, part.attr) for part in parts if isinstance(part, ast.Attribute)
        ),
        block,
        tuple(docstrings(parts, start)),
        tuple(_members(node, lines, start)),
    )


def _members(node: ast.stmt, lines: list[str], start: int) -> Iterator[Member]:
    for part in node.body if isinstance(node, ast.ClassDef) else ():
        bare = isinstance(part, ast.FunctionDef) and not part.decorator_list
        if isinstance(part, ast.FunctionDef) and bare and not part.name.startswith("__"):
            first = part.lineno
            while not lines[first - 2].strip() or lines[first - 2].lstrip().startswith("#"):
                first -= 1
            yield Member(part.name, first - start, (part.end_lineno or 0) - start)


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
