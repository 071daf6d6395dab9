"""What expressions are computed from."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping

from ikgen.algebra.expression import Expr

__all__ = ["dependencies"]


def dependencies(
    roots: Iterable[Expr], definition: Mapping[int, Expr], known: Container[int] = ()
) -> Iterator[Expr]:
    """Each expression that the roots follow from once, themselves too, the last root first. `definition`
    (id of an atom -> expression) is what atoms stand for; what those in `known` (ids) follow from is left
    out."""
    seen: set[int] = set()
    stack = list(roots)
    while stack:
        node = stack.pop()
        if node.id in seen:
            continue
        seen.add(node.id)
        yield node
        if node.id not in known:
            stack += (definition[node.id],) if node.id in definition else node.args
