"""Solve a chain: tick the tree until every joint is known."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import replace

from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.equations.equation_set import EquationSet
from ikgen.equations.knowledge import Knowledge, Variable
from ikgen.equations.probes import make_probes
from ikgen.equations.readable import readable_in_dh
from ikgen.model.dh import DHChain
from ikgen.model.entry_names import ENTRY_NAMES
from ikgen.solver.behavior_tree import Tree, outline, the_tree, tick
from ikgen.solver.leaves import Leaf, all_leaves
from ikgen.solver.session import Session
from ikgen.solver.solution_graph import SolutionGraph, graph_of

__all__ = ["solve_chain"]


def solve_chain(
    dh: DHChain,
    *,
    readable: frozenset[str] = frozenset(ENTRY_NAMES),
    tool_on_right: bool = False,
    leaves: Sequence[Leaf] | None = None,
    tree: Tree | None = None,
    progress: Callable[[str], None] | None = None,
    passed_over: Collection[Variable] = (),
    among: Collection[str] | None = None,
) -> SolutionGraph:
    """Closed forms for every joint variable of `dh`; `graph.open_joints` lists what is left.

    `readable` names the pose entries that the task reads; with `tool_on_right` the tool transform is
    part of the chain (tasks that do not read the whole pose). `leaves` are by default ikgen's own and
    those of other packages, `tree` ikgen's own or that of another package. Unknowns that are
    `passed_over` are not to be the first that is solved with branches. `among` are the labels of the only
    equations to look at, where a derivation of nearly the same chain tells which lead somewhere.
    """
    readable = readable_in_dh(dh, readable)
    probes = make_probes(dh, tool=tool_on_right, readable=readable)
    graph = ExpressionGraph(len(probes.values))
    system = EquationSet(
        graph,
        dh,
        probes.values,
        probes.pose,
        readable=readable,
        tool_on_right=tool_on_right,
        kept=probes.kept,
    )
    knowledge = Knowledge(system)
    _ = system.equations  # made here: held joints are marked as known in the atoms that there are
    session = Session(system, probes, knowledge, dh.free_indices, passed_over, among)
    session.start()
    root = (tree or the_tree()).build(session, all_leaves() if leaves is None else leaves)
    while session.open_joints:
        solved = len(session.steps)
        if not tick(root, session) or len(session.steps) == solved:
            break
        if progress is not None:
            progress(session.steps[-1].candidate.unknown.text)
    return replace(graph_of(session), outline=outline(root))
