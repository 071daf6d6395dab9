"""Text of the runtime without the branches that one arm never takes."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator, Mapping
from itertools import pairwise

__all__ = ["SOME", "Facts", "facts_in", "settled"]

Facts = tuple[tuple[str, object], ...]
"""What is known of an `Arm` when its module is written: names of attributes (`rounded`,
`policy.beside_anywhere`) and their values."""

SOME = object()
"""Stands for what is not None, and not empty: arms have the same texts whatever joints they hold."""

_UNKNOWN = object()
_COMPARED: Mapping[type[ast.cmpop], Callable[[object, object], bool]] = {
    ast.Is: lambda a, b: a is b,
    ast.IsNot: lambda a, b: a is not b,
    ast.Eq: lambda a, b: a == b,
}
_ENDS = (ast.Return, ast.Raise, ast.Continue, ast.Break)
_Known = Mapping[str, object]
_Place = tuple[int, int]  # line from 1, column in bytes
_Span = tuple[_Place, _Place]
_Patch = tuple[
    int, int, list[bytes]
]  # what comes instead of lines, from the first to the last (from 1)


def settled(text: str, facts: Facts) -> str:
    """A module's text without what conditions on attributes of `arm`, or of a member `arm`, leave out of
    its definitions, and without statements behind the end of a block there; `Arm` itself with the types
    that the attributes have."""
    if not facts_in(text, facts):
        return text
    lines = text.split("\n")
    for node in reversed(ast.parse(text).body):
        span = slice(node.lineno - 1, node.end_lineno)
        part = "\n".join(lines[span])
        known = facts_in(part, facts)
        if known:
            lines[span] = _settled(part, dict(known)).split("\n")
    return "\n".join(lines)


def facts_in(text: str, facts: Facts) -> Facts:
    """The facts that a text mentions."""
    if "class Arm:" in text:
        return facts
    return tuple(one for one in facts if f"arm.{one[0]}" in text)


def _settled(text: str, known: _Known) -> str:
    """One definition's text, as often changed as there is more to leave out."""
    while True:
        lines = [line.encode() for line in text.split("\n")]
        patches = sorted(_patches(ast.parse(text), lines, known), key=lambda one: one[:2])
        if not patches:
            return text
        end = 0
        for first, last, new in _apart(patches):
            lines[end + first - 1 : end + last] = new
            end += len(new) - (last - first + 1)
        text = b"\n".join(lines).decode()


def _apart(patches: list[_Patch]) -> Iterator[_Patch]:
    """The patches that do not touch one before."""
    end = 0
    for one in patches:
        if one[0] > end:
            end = one[1]
            yield one


def _patches(tree: ast.Module, lines: list[bytes], known: _Known) -> Iterator[_Patch]:
    """All changes that can be made to the text as it is."""
    for node in ast.walk(tree):
        for name in ("body", "orelse", "finalbody"):
            block = getattr(node, name, None)
            if isinstance(block, list):
                yield from _shorter(block, lines, known)
        if isinstance(node, ast.ClassDef) and node.name == "Arm":
            yield from _plainer_types(node, lines, known)
        if isinstance(node, ast.IfExp):
            value = _value(node.test, known)
            if value is not _UNKNOWN:
                stays = _with_brackets(node.body if value else node.orelse, lines)
                yield _only(lines, _span(node), stays)
        for test in (getattr(node, "test", None), *getattr(node, "ifs", ())):
            if isinstance(test, ast.BoolOp):
                yield from _fewer_operands(test, lines, known)


def _shorter(block: list[ast.stmt], lines: list[bytes], known: _Known) -> Iterator[_Patch]:
    for one, after in pairwise(block):
        if isinstance(one, _ENDS):
            yield after.lineno, block[-1].end_lineno or 0, []
    for node in block:
        value = _value(node.test, known) if isinstance(node, ast.If) else _UNKNOWN
        if isinstance(node, ast.If) and value is not _UNKNOWN:
            stays = node.body if value else node.orelse
            if stays or len(block) > 1:  # something has to stay
                yield node.lineno, node.end_lineno or 0, list(_instead(node, stays, lines))


def _instead(node: ast.If, stays: list[ast.stmt], lines: list[bytes]) -> Iterator[bytes]:
    """One of its blocks in place of a condition."""
    if not stays:
        return
    indent = lines[node.lineno - 1][: node.col_offset]
    further = lines[node.lineno - 1][node.col_offset :].startswith(b"elif")
    first, last = stays[0].lineno, stays[-1].end_lineno or 0
    if stays[0].col_offset == node.col_offset:  # elif
        head = lines[first - 1][node.col_offset + len(b"elif") :]
        yield indent + (b"elif" if further else b"if") + head
        yield from lines[first:last]
        return
    while not lines[first - 2].partition(b"#")[0].rstrip().endswith(b":"):
        first -= 1  # comments above
    if further:
        yield indent + b"else:"
    less = 0 if further else stays[0].col_offset - node.col_offset
    yield from (line[less:] for line in lines[first - 1 : last])


def _plainer_types(node: ast.ClassDef, lines: list[bytes], known: _Known) -> Iterator[_Patch]:
    """With the one of two types that an attribute has which may be None."""
    for part in node.body:
        if isinstance(part, ast.AnnAssign) and isinstance(part.annotation, ast.BinOp):
            value = known.get(ast.unparse(part.target), _UNKNOWN)
            if value is not _UNKNOWN:
                union = part.annotation
                yield _only(lines, _span(union), _span(union.left if value else union.right))


def _fewer_operands(node: ast.BoolOp, lines: list[bytes], known: _Known) -> Iterator[_Patch]:
    """Drops operands of `and`/`or` that are known not to decide."""
    plain = isinstance(node.op, ast.And)
    spans = [_with_brackets(one, lines) for one in node.values]
    whole = spans[0][0], spans[-1][1]
    for k, one in enumerate(node.values):
        value = _value(one, known)
        if value is not _UNKNOWN and bool(value) is plain:
            if k == 0:
                yield _only(lines, whole, (spans[1][0], whole[1]))
            else:
                yield _only(lines, (spans[k - 1][1], spans[k][1]), (spans[k][1], spans[k][1]))
        elif isinstance(one, ast.BoolOp):
            yield from _fewer_operands(one, lines, known)


def _only(lines: list[bytes], whole: _Span, stays: _Span) -> _Patch:
    """A part of the text with only one part of that."""
    ((i, a), (j, b)), ((k, c), (n, d)) = whole, stays
    part = lines[k - 1 : n]
    part[-1] = part[-1][:d] + lines[j - 1][b:]
    part[0] = lines[i - 1][:a] + part[0][c:]
    return i, j, part


def _span(node: ast.expr) -> _Span:
    return (node.lineno, node.col_offset), (node.end_lineno or 0, node.end_col_offset or 0)


def _with_brackets(node: ast.expr, lines: list[bytes]) -> _Span:
    """Where an operand is, with brackets around it alone."""
    (i, a), (j, b) = _span(node)
    while lines[i - 1][a - 1 : a] == b"(" and lines[j - 1][b : b + 1] == b")":
        a, b = a - 1, b + 1
    return (i, a), (j, b)


def _value(node: ast.expr, known: _Known) -> object:
    """What a condition is, or `_UNKNOWN`."""
    if isinstance(node, ast.Constant):
        return node.value
    if isinstance(node, ast.Attribute):
        return _fact(node, known)
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
        value = _value(node.operand, known)
        return value if value is _UNKNOWN else not value
    if isinstance(node, ast.BoolOp):
        values = [_value(one, known) for one in node.values]
        short = isinstance(node.op, ast.Or)
        if any(v is not _UNKNOWN and bool(v) is short for v in values):
            return short
        return _UNKNOWN if _UNKNOWN in values else not short
    if isinstance(node, ast.Compare) and len(node.ops) == 1:
        pair = _value(node.left, known), _value(node.comparators[0], known)
        compared = _COMPARED.get(type(node.ops[0]))
        vague = SOME in pair and None not in pair
        return _UNKNOWN if _UNKNOWN in pair or compared is None or vague else compared(*pair)
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "len":
        value = _value(node.args[0], known)
        return value if value is SOME else len(value) if isinstance(value, tuple) else _UNKNOWN
    return _UNKNOWN


def _fact(node: ast.Attribute, known: _Known) -> object:
    names: list[str] = []
    base: ast.expr = node
    while isinstance(base, ast.Attribute) and base.attr.lstrip("_") != "arm":
        names.insert(0, base.attr)
        base = base.value
    arm: str = base.attr if isinstance(base, ast.Attribute) else getattr(base, "id", "")
    return known.get(".".join(names), _UNKNOWN) if arm.lstrip("_") == "arm" else _UNKNOWN
