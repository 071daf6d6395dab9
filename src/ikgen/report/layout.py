"""Where the unknowns of a solution graph stand, and how arrows go around them (Sugiyama's layers)."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

from ikgen.equations.knowledge import Variable
from ikgen.solver.solution_graph import SolutionGraph

__all__ = ["Layout", "layout"]

_SWEEPS = 4

_Node = Variable | tuple[Variable, Variable, int]
"""An unknown, or a place in the given row that the arrow between two unknowns passes through."""

Place = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Layout:
    """`place`: column and row of every unknown, all its parents above it. `routes`: per arrow the
    places that it runs through, ends included; no two of any row are the same."""

    place: dict[Variable, Place]
    routes: dict[tuple[Variable, Variable], tuple[Place, ...]]


def layout(graph: SolutionGraph) -> Layout:
    """Places for every unknown but the sums that the graph passes through."""
    parents = {v: above for v, above in graph.parents if v not in graph.passed}
    row: dict[Variable, int] = {}

    def depth(v: Variable) -> int:
        if v not in row:
            row[v] = 1 + max((depth(p) for p in parents[v] if p in parents), default=-1)
        return row[v]

    for v in parents:
        depth(v)
    chains: dict[tuple[Variable, Variable], tuple[_Node, ...]] = {
        (p, v): (p, *((p, v, r) for r in range(row[p] + 1, row[v])), v)
        for v, above in parents.items()
        for p in above
        if p in row
    }
    layers = _layers(row, chains)
    column = _columns(layers, chains)
    at: dict[_Node, Place] = {
        node: (column[node], float(r)) for r, layer in enumerate(layers) for node in layer
    }
    return Layout(
        {v: at[v] for v in row},
        {edge: tuple(at[node] for node in chain) for edge, chain in chains.items()},
    )


def _layers(
    row: dict[Variable, int], chains: dict[tuple[Variable, Variable], tuple[_Node, ...]]
) -> list[list[_Node]]:
    layers: list[list[_Node]] = [[] for _ in range(max(row.values(), default=-1) + 1)]
    for v, r in row.items():
        layers[r].append(v)
    for chain in chains.values():
        for node in chain[1:-1]:
            assert isinstance(node, tuple)
            layers[node[2]].append(node)
    return layers


def _columns(
    layers: list[list[_Node]], chains: dict[tuple[Variable, Variable], tuple[_Node, ...]]
) -> dict[_Node, float]:
    """Order each layer by the mean column of what a node is connected with, down and up in turn."""
    linked: dict[_Node, list[_Node]] = {node: [] for layer in layers for node in layer}
    for chain in chains.values():
        for one, two in pairwise(chain):
            linked[one].append(two)
            linked[two].append(one)
    widest = max((len(layer) for layer in layers), default=0)
    column: dict[_Node, float] = {}
    level = {node: r for r, layer in enumerate(layers) for node in layer}

    def spread(layer: list[_Node]) -> None:
        start = (widest - len(layer)) / 2
        column.update({node: start + i for i, node in enumerate(layer)})

    for layer in layers:
        spread(layer)
    for sweep in range(_SWEEPS):
        down = sweep % 2 == 0
        for r, layer in enumerate(layers) if down else reversed(list(enumerate(layers))):
            beside = r - 1 if down else r + 1

            def wish(node: _Node, beside: int = beside) -> float:
                xs = [column[other] for other in linked[node] if level[other] == beside]
                return sum(xs) / len(xs) if xs else column[node]

            layer.sort(key=wish)
            spread(layer)
    return column
