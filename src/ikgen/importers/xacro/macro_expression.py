"""xacro's expressions, computed from their syntax tree: Python's compiler never sees them.

An expression may compute with numbers, texts, lists and dictionaries, name what the file and xacro
define, and call those functions; see `docs/reference/robot-files.md` for all of it. Everything else of
Python's language is refused, so that no attribute leads from a value to the interpreter.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol

from ikgen.importers.xacro.bounded_values import OPERATORS, checked, gathered
from ikgen.importers.xacro.budget import Budget
from ikgen.importers.xacro.comprehension import bindings
from ikgen.importers.xacro.refusals import RefusedExpressionError
from ikgen.importers.xacro.value_attributes import attribute_of

__all__ = ["Evaluator", "Names"]

_LONGEST = 10_000
_DEEPEST = 60
_PLAIN = (int, float, complex, str, bool, type(None))


class Names(Protocol):
    """Where names are looked up: raises `KeyError` for one that is not there."""

    def __getitem__(self, name: str, /) -> Any: ...


@dataclass(slots=True)
class Evaluator:
    """Computes expressions, each parsed once; `budget` is what they may use together."""

    budget: Budget
    parsed: dict[str, ast.expr] = field(default_factory=dict)

    def evaluate(self, text: str, names: Names) -> Any:
        """The value of an expression. Raises `RefusedExpressionError`, `ExpansionLimitError`, and
        what the expression's own operations raise."""
        try:
            tree = self.parsed.get(text)
            if tree is None:
                tree = self.parsed[text] = _parse(text)
            value = _Scope(self.budget, names).value(tree)
        except RefusedExpressionError as refusal:
            refusal.expression = refusal.expression or text
            raise
        if callable(value):  # no value of a description: a property was meant that is not there
            raise NameError(f"'{text.strip()}' is a function, not a property of the file")
        return value


def _parse(text: str) -> ast.expr:
    if len(text) > _LONGEST:
        raise RefusedExpressionError(f"has {len(text)} characters")
    try:
        tree = ast.parse(text.strip(), "<expression>", "eval").body
    except (MemoryError, RecursionError):
        raise RefusedExpressionError("nests too deep") from None
    level: list[ast.AST] = [tree]
    for _ in range(_DEEPEST):
        level = [child for node in level for child in ast.iter_child_nodes(node)]
        if not level:
            return tree
    raise RefusedExpressionError("nests too deep")


@dataclass(slots=True)
class _Scope:
    """Names of one expression: those of its comprehensions, then the file's."""

    budget: Budget
    names: Names
    local: Mapping[str, Any] = field(default_factory=dict)

    def value(self, node: ast.expr) -> Any:
        self.budget.add_step()
        compute = _COMPUTE.get(type(node))
        if compute is None:
            raise RefusedExpressionError(f"uses {_in_words(node)}")
        return compute(self, node)

    def values(self, nodes: list[ast.expr]) -> Iterator[Any]:
        for node in nodes:
            if isinstance(node, ast.Starred):
                yield from self.value(node.value)
            else:
                yield self.value(node)

    def named(self, name: str) -> Any:
        if name.startswith("__"):
            raise RefusedExpressionError(f"names '{name}'")
        if name in self.local:
            return self.local[name]
        try:
            return self.names[name]
        except KeyError:
            raise NameError(f"name '{name}' is not defined") from None

    def within(self, local: Mapping[str, Any]) -> _Scope:
        return _Scope(self.budget, self.names, {**self.local, **local})


def _in_words(node: ast.AST) -> str:
    words = {"Lambda": "a lambda", "JoinedStr": "an f-string", "NamedExpr": "':='"}
    name = type(node).__name__
    return words.get(name, f"Python's '{name}'")


def _constant(scope: _Scope, node: ast.Constant) -> Any:
    if not isinstance(node.value, _PLAIN):
        raise RefusedExpressionError(f"uses a constant of type {type(node.value).__name__}")
    return checked(node.value)


def _binary(scope: _Scope, node: ast.BinOp) -> Any:
    return checked(_operator(node.op)(scope.value(node.left), scope.value(node.right)))


def _operator(sign: ast.AST) -> Callable[..., Any]:
    name = type(sign).__name__
    if name not in OPERATORS:
        raise RefusedExpressionError(f"uses Python's '{name}'")
    return OPERATORS[name]


def _all_of(scope: _Scope, node: ast.BoolOp) -> Any:
    decides = isinstance(node.op, ast.Or)
    for part in node.values:
        value = scope.value(part)
        if bool(value) is decides:
            break
    return value


def _comparison(scope: _Scope, node: ast.Compare) -> Any:
    left = scope.value(node.left)
    for sign, part in zip(node.ops, node.comparators, strict=True):
        right = scope.value(part)
        holds = _operator(sign)(left, right)
        if not holds:
            break
        left = right
    return holds


def _choice(scope: _Scope, node: ast.IfExp) -> Any:
    return scope.value(node.body if scope.value(node.test) else node.orelse)


def _dictionary(scope: _Scope, node: ast.Dict) -> Any:
    result: dict[Any, Any] = {}
    for key, value in zip(node.keys, node.values, strict=True):
        if key is None:
            result.update(scope.value(value))
        else:
            result[scope.value(key)] = scope.value(value)
    return checked(result)


def _slice(scope: _Scope, node: ast.Slice) -> slice:
    ends = (node.lower, node.upper, node.step)
    return slice(*(None if end is None else scope.value(end) for end in ends))


def _call(scope: _Scope, node: ast.Call) -> Any:
    function = scope.value(node.func)
    if not callable(function):
        raise TypeError(f"'{type(function).__name__}' object is not callable")
    positional = list(scope.values(node.args))
    named: dict[str, Any] = {}
    for keyword in node.keywords:
        value = scope.value(keyword.value)
        named.update(value if keyword.arg is None else {keyword.arg: value})
    return checked(function(*positional, **named))


def _comprehension(
    scope: _Scope, node: ast.ListComp | ast.SetComp | ast.GeneratorExp
) -> Iterator[Any]:
    for local in bindings(scope, node.generators):
        yield scope.within(local).value(node.elt)


def _items(scope: _Scope, node: ast.DictComp) -> Iterator[tuple[Any, Any]]:
    for local in bindings(scope, node.generators):
        inner = scope.within(local)
        yield inner.value(node.key), inner.value(node.value)


_COMPUTE: Mapping[type[ast.AST], Callable[[_Scope, Any], Any]] = {
    ast.Constant: _constant,
    ast.Name: lambda scope, node: scope.named(node.id),
    ast.BinOp: _binary,
    ast.UnaryOp: lambda scope, node: checked(_operator(node.op)(scope.value(node.operand))),
    ast.BoolOp: _all_of,
    ast.Compare: _comparison,
    ast.IfExp: _choice,
    ast.List: lambda scope, node: checked(list(scope.values(node.elts))),
    ast.Tuple: lambda scope, node: checked(tuple(scope.values(node.elts))),
    ast.Set: lambda scope, node: checked(set(scope.values(node.elts))),
    ast.Dict: _dictionary,
    ast.Slice: _slice,
    ast.Subscript: lambda scope, node: scope.value(node.value)[scope.value(node.slice)],
    ast.Attribute: lambda scope, node: attribute_of(scope.value(node.value), node.attr),
    ast.Call: _call,
    ast.ListComp: lambda scope, node: gathered(_comprehension(scope, node)),
    ast.GeneratorExp: lambda scope, node: gathered(_comprehension(scope, node)),
    ast.SetComp: lambda scope, node: set(gathered(_comprehension(scope, node))),
    ast.DictComp: lambda scope, node: dict(gathered(_items(scope, node))),
}
