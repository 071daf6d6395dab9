"""The loops of comprehensions in expressions."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping
from typing import Any, Protocol

from ikgen.importers.xacro.refusals import RefusedExpressionError

__all__ = ["bindings"]


class _Scope(Protocol):
    def value(self, node: ast.expr) -> Any: ...

    def within(self, local: Mapping[str, Any]) -> _Scope: ...


def bindings(scope: _Scope, loops: list[ast.comprehension]) -> Iterator[Mapping[str, Any]]:
    """The names that the loops of a comprehension bind, once for each turn that its conditions let
    through."""
    first, *inner = loops
    if first.is_async:
        raise RefusedExpressionError("uses Python's 'async'")
    for item in scope.value(first.iter):
        local = _bound(first.target, item)
        turn = scope.within(local)
        if not all(turn.value(condition) for condition in first.ifs):
            continue
        if not inner:
            yield local
            continue
        for more in bindings(turn, inner):
            yield {**local, **more}


def _bound(target: ast.expr, item: Any) -> dict[str, Any]:
    """The names of a loop's target, a name or a tuple of them, with their values."""
    if isinstance(target, ast.Name):
        return {target.id: item}
    if not isinstance(target, ast.Tuple | ast.List):
        raise RefusedExpressionError("binds something else than names")
    parts = list(item)
    if len(parts) != len(target.elts):
        raise ValueError(f"{len(parts)} values for {len(target.elts)} names")
    bound: dict[str, Any] = {}
    for part, value in zip(target.elts, parts, strict=True):
        bound.update(_bound(part, value))
    return bound
