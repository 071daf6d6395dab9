"""Leaves written in SymPy solve arms, in the emitted code too, and are proved before they may."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import sympy
from sympy import atan2, cos, sin, sqrt, symbols
from tests.solver.test_plugged_in import documented
from tests.support.solving import import_text, module_of

from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.emit.cpp.cpp_emitter import emit_header
from ikgen.emit.python.python_emitter import emit_module
from ikgen.errors import PlugInError
from ikgen.forms.lowered_form import Tolerances
from ikgen.importers.dh.dh_table import read_dh_table
from ikgen.model.dh import DHChain
from ikgen.solver.leaves import LEAVES, Leaf
from ikgen.solver.solution_graph import SolutionGraph
from ikgen.solver.solve import solve_chain
from ikgen.symbolic import sympy_leaf
from ikgen.symbolic.proof import prove_graph
from ikgen.symbolic.sympy_form import Recipe, form_class

TABLES = Path(__file__).resolve().parents[1] / "robots/tables"
x, u, A, B, C = symbols("x u A B C", real=True)


def _table(name: str) -> DHChain:
    return read_dh_table(TABLES / f"{name}.toml", free=(), locked={})[1]


def _rows_are_right(dh: DHChain, graph: SolutionGraph, folder: Path) -> None:
    module = import_text(emit_module(module_of(dh, graph)), folder)
    for q in np.random.default_rng(3).uniform(0.2, 1.4, (40, dh.dof)):
        pose = module.forward(q)
        found = module.solve(pose, limits=False).q
        assert np.abs(module.forward(found) - pose).max() < 1e-9
        assert np.abs(found - q).max(axis=1).min() < 1e-6


def test_documented_leaf_solves_proves_and_emits(tmp_path: Path) -> None:
    monic = documented("add-a-leaf.md", "sympy", "SYMBOLIC")
    assert isinstance(monic, Leaf)
    dh = _table("Wachtveitl")
    others = [leaf for leaf in LEAVES if leaf.name == "simultaneous"]
    assert solve_chain(dh, leaves=others).open_joints
    graph = solve_chain(dh, leaves=[*others, monic])
    assert not graph.open_joints
    assert "monic quadratic" in {s.candidate.form.name for s in graph.steps}
    proof = prove_graph(graph)
    assert proof.proved and "monic quadratic" in {one.form for one in proof.forms}
    _rows_are_right(dh, graph, tmp_path)
    assert "monic quadratic" in emit_header(module_of(dh, graph))


def test_an_angle_takes_the_place_of_the_own_leaf(tmp_path: Path) -> None:
    slope = sympy_leaf("slope", u, A * cos(u) + B * sin(u), atan2(-A, B), atan2(A, -B))
    dh = _table("KR16")
    others = [leaf for leaf in LEAVES if leaf.name in ("simultaneous", "tangent")]
    two = sympy_leaf(
        "amplitude",
        u,
        A * cos(u) + B * sin(u) + C,
        *(atan2(B, A) + s * atan2(sqrt(A**2 + B**2 - C**2), -C) for s in (1, -1)),
    )
    graph = solve_chain(dh, leaves=[*others, slope, two])
    assert not graph.open_joints
    assert {"slope", "amplitude"} <= {s.candidate.form.name for s in graph.steps}
    assert prove_graph(graph).proved
    _rows_are_right(dh, graph, tmp_path)


def test_the_form_without_a_constant() -> None:
    leaf = documented("add-a-leaf.md", "sympy without constant", "NO_CONSTANT")
    assert isinstance(leaf, Leaf)
    recipe = Recipe(x, A * x**2 + B * x, (A, B), (sympy.S.Zero, -B / A))
    g = ExpressionGraph(2)
    a, b = (
        g.atom("input", name, np.array(values), unknown=False)
        for name, values in (("a", [2.0, 4.0]), ("b", [3.0, -1.0]))
    )
    form = form_class("no constant", recipe)(a, b)
    found = [one[0] for one in form.values(form.probe)]
    np.testing.assert_allclose(found, [[0.0, 0.0], [-1.5, 0.25]])
    assert form.discriminant() is None
    for sign, wanted in ((1.0, found[0]), (-1.0, found[1])):
        lowered = form.lower(g, g.const(sign), Tolerances())
        np.testing.assert_allclose(lowered.values[0].probe, wanted)


@pytest.mark.parametrize(
    ("equation", "solutions", "reason"),
    [
        (x**2 + B * x + C, (B / 2 + sqrt(B**2 / 4 - C), B / 2 - sqrt(B**2 / 4 - C)), "not solve"),
        (x**2 + B * x + C, (-B / 2 + sqrt(B**2 / 4 - C),), "in no branch"),
        (A * x**2 + A * x, (0, -1), "cannot be matched"),
        (A * x**2 + B * x + C, (), "0 solutions"),
        (A * x**4 + B, tuple(s * (-B / A) ** sympy.Rational(1, 4) for s in (1, -1)), "neither sum"),
    ],
)
def test_what_is_wrong_is_refused(
    equation: sympy.Expr, solutions: tuple[sympy.Expr, ...], reason: str
) -> None:
    with pytest.raises(PlugInError, match=reason):
        sympy_leaf("mine", x, equation, *solutions)
