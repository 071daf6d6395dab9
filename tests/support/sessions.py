"""Sessions of solving a chain, to the point where transforms begin."""

from __future__ import annotations

from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.equations.equation_set import EquationSet
from ikgen.equations.knowledge import Knowledge
from ikgen.equations.probes import make_probes
from ikgen.model.dh import DHChain
from ikgen.solver.session import Session

__all__ = ["collected_session"]


def collected_session(dh: DHChain) -> Session:
    """The first round's, its equations collected."""
    probes = make_probes(dh)
    system = EquationSet(ExpressionGraph(len(probes.values)), dh, probes.values, probes.pose)
    _ = system.equations
    session = Session(system, probes, Knowledge(system))
    session.start()
    session.collect()
    return session
