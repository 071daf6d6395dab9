"""What macros and blocks copy of a document, counted before it is copied."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from ikgen.importers.xacro.budget import Budget

__all__ = ["counted_copies"]


def counted_copies(xacro: Any, budget: Budget) -> Iterator[tuple[Any, str, Any]]:
    """(module, name, replacement) for the functions of the package `xacro` that copy nodes."""
    resolve_macro, replace_node = xacro.resolve_macro, xacro.replace_node
    sizes: dict[int, tuple[Any, int]] = {}

    def resolve(fullname: str, macros: Any, symbols: Any) -> Any:
        found = resolve_macro(fullname, macros, symbols)
        body = found[2].body
        if id(body) not in sizes:
            sizes[id(body)] = (body, _nodes(body))  # kept, so that no other gets its number
        budget.add_nodes(sizes[id(body)][1])
        return found

    def replace(node: Any, by: Any, content_only: bool = False) -> None:
        if getattr(node, "tagName", "") == "xacro:insert_block":
            budget.add_nodes(_nodes(by))
        replace_node(node, by, content_only)

    yield xacro, "resolve_macro", resolve
    yield xacro, "replace_node", replace


def _nodes(root: Any) -> int:
    count = 0
    waiting = [root]
    while waiting:
        node = waiting.pop()
        count += 1
        waiting += node.childNodes
    return count
