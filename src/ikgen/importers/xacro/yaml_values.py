"""YAML files for expressions: plain data of a bounded size, with xacro's tags for units."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from ikgen.importers.xacro.bounded_values import LARGEST
from ikgen.importers.xacro.refusals import ExpansionLimitError

__all__ = ["LARGEST_YAML", "parse_yaml"]

LARGEST_YAML = 2**19
"""The most bytes of a YAML file; published ones have some 3 kB."""

_DEEPEST = 100


def parse_yaml(
    text: str,
    name: str,
    units: Mapping[str, Callable[[str], float]],
    check: Callable[[Any], None] = lambda node: None,
) -> Any:
    """The data of a YAML text; `name` is for the marks of its errors, `check` looks at its nodes before.

    `units` gives the value of a scalar with a tag (`!degrees 90`). Raises `yaml.YAMLError`, and
    `ExpansionLimitError` for aliases that multiply beyond bounds.
    """
    import yaml

    # A class of its own: constructors belong to classes.
    loader_class: Any = type("Loader", (yaml.SafeLoader,), {})
    for tag, value in units.items():
        loader_class.add_constructor(tag, _unit(value))
    loader = loader_class(text)
    loader.name = name
    try:
        node = loader.get_single_node()
        if node is None:
            return None
        _size(node, {}, 0)
        check(node)
        return loader.construct_document(node)
    except RecursionError:
        raise ExpansionLimitError("reads YAML that nests too deep") from None
    finally:
        loader.dispose()


def _unit(value: Callable[[str], float]) -> Callable[[Any, Any], float]:
    return lambda loader, node: value(loader.construct_scalar(node))


def _size(node: Any, known: dict[int, int], depth: int) -> int:
    """How many values a node stands for, aliases written out; one inside itself has no end."""
    if depth > _DEEPEST:
        raise ExpansionLimitError("reads YAML that nests too deep or contains itself")
    if id(node) not in known:
        parts = node.value if isinstance(node.value, list) else []
        flat = [part for one in parts for part in (one if isinstance(one, tuple) else (one,))]
        known[id(node)] = 1 + sum(_size(part, known, depth + 1) for part in flat)
    if known[id(node)] > LARGEST:
        raise ExpansionLimitError(f"reads YAML of more than {LARGEST:,} values")
    return known[id(node)]
