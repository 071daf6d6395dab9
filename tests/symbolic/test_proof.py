"""Derivations are proved exactly, and what is false is found to be."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from tests.support.solving import FIXTURES
from tests.support.tables import table

from ikgen.derivation.derive import derive
from ikgen.emit.derivation import Derivation
from ikgen.equations.equation import Equation
from ikgen.records.request import Request
from ikgen.solver.solution_graph import SolutionGraph
from ikgen.solver.solve import solve_chain
from ikgen.symbolic import equations, prove
from ikgen.symbolic.identities import prove_identities
from ikgen.symbolic.proof import prove_graph

pytestmark = pytest.mark.usefixtures("solved_once")


@pytest.fixture(scope="module")
def puma() -> Derivation:
    return derive(Request(FIXTURES / "puma560_paper.toml"))


def test_pumas_derivation_is_proved(puma: Derivation) -> None:
    proof = prove(puma)
    assert proof.proved and not proof.wrong
    assert proof.words.startswith("proved: 10 of 10 equations")
    assert len(proof.patterns) == len(puma.graph.steps) == 6
    assert {one.form for one in proof.forms} == {"sincos", "pair", "tangent"}
    assert not proof.remarks
    assert len(equations(puma)) == 10


@pytest.mark.parametrize("name", ["puma560_symbolic", "olson13", "scara_standard"])
def test_fixtures_are_proved(name: str) -> None:
    derivation = derive(Request(FIXTURES / f"{name}.toml"))
    assert prove(derivation).proved


def _with_equation(graph: SolutionGraph, wrong: Equation) -> SolutionGraph:
    """The graph with another equation as the first step's source."""
    first, *rest = graph.steps
    candidate = replace(first.candidate, sources=(wrong,))
    return replace(graph, steps=(replace(first, candidate=candidate), *rest))


def test_an_equation_with_a_wrong_sign_is_refuted(puma: Derivation) -> None:
    graph = replace(puma.graph, _known=puma.graph.workspace())
    used = graph.steps[1].candidate.sources[0]
    wrong = replace(used, left=graph._known.graph.neg(used.left))
    matrix, _ = prove_identities(_with_equation(graph, wrong))
    assert not matrix[0].proved and matrix[0].wrong
    assert "differ" in matrix[0].reason
    assert all(one.proved for one in matrix[1:])


def test_a_coefficient_that_is_slightly_off_is_refuted(puma: Derivation) -> None:
    graph = replace(puma.graph, _known=puma.graph.workspace())
    g = graph._known.graph
    first, *rest = graph.steps
    form = first.candidate.form
    off = replace(form, c=g.mul(g.const(1.0 + 2.0**-20), form.c))  # type: ignore[call-arg]
    candidate = replace(first.candidate, form=off)
    altered = replace(graph, steps=(replace(first, candidate=candidate), *rest))
    proof = prove_graph(altered)
    assert not proof.proved and proof.wrong
    assert [one.proved for one in proof.patterns] == [False, *[True] * 5]


def test_twists_of_square_roots_are_exact() -> None:
    """45 and 75 degrees: cosines in the field of sqrt(2) and sqrt(3)."""
    for twist in (0.5, 5 / 6):
        rows = [("R", 0, 0, 0.3), ("R", twist, 0.4, 0.1), ("R", 0, 0.5, 0.0)]
        graph = solve_chain(table(*rows))
        proof = prove_graph(graph)
        assert proof.equations and proof.proved, proof.remarks


def test_proof_says_what_the_elimination_is() -> None:
    tables = Path(__file__).resolve().parents[1] / "robots" / "tables"
    proof = prove(derive(Request(tables / "KawasakiRS05L.toml")))
    assert not proof.proved and not proof.wrong
    assert "elimination" in proof.words


def test_generation_imports_neither_sympy_nor_the_report(tmp_path: Path) -> None:
    robot = FIXTURES / "olson13.toml"
    script = (
        "import runpy, sys\n"
        f"sys.argv = ['ikgen', 'from-dh', {str(robot)!r}, '-o', {str(tmp_path)!r}, '--samples', '5']\n"
        "try:\n    runpy.run_module('ikgen', run_name='__main__')\n"
        "except SystemExit as end:\n    print('exit', end.code)\n"
        "print(*(name in sys.modules for name in ('sympy', 'ikgen.report', 'pinocchio')))\n"
    )
    done = subprocess.run([sys.executable, "-c", script], text=True, capture_output=True)
    assert list(tmp_path.glob("*_ik.py")), done.stderr
    assert done.stdout.split()[-3:] == ["False", "False", "True"]
