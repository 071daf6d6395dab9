"""Forms with more than two branches, as packages bring them: each branch by itself, told apart by signs."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import pytest
from tests.support.solving import NO_COMPILER, import_text, module_from
from tests.support.twist_arm import REACH, TWIST

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.equations.knowledge import Knowledge, PolynomialEquation, Variable
from ikgen.errors import PlugInError
from ikgen.forms.form import Form
from ikgen.forms.lowered_form import (
    Divisor,
    LoweredBranches,
    LoweredForm,
    Tolerances,
)
from ikgen.generation.generate import generate
from ikgen.lowering.sign_levels import as_one_each, more_signs
from ikgen.model.arrays import Array
from ikgen.records.request import Outputs, Request
from ikgen.solver import leaves
from ikgen.solver.candidate import Candidate
from ikgen.solver.leaves import LEAVES, Leaf
from ikgen.tasks import TASKS

EXAMPLE = module_from(Path(__file__).resolve().parents[2] / "examples/plugin_leaf/double_angle.py")
DoubleAngle: Any = EXAMPLE.DoubleAngle


class Twice(DoubleAngle):
    """With its first branch once more: no power of two."""

    branches: ClassVar[int] = 5

    def values(self, c: Sequence[Array]) -> list[tuple[Array, ...]]:
        found = DoubleAngle.values(self, c)
        return [*found, found[0]]

    def lower(self, g: ExpressionGraph, sigma: Expr, tolerances: Tolerances) -> LoweredBranches:
        found = DoubleAngle.lower(self, g, sigma, tolerances)
        values, guards = (*found.values, found.values[0]), (*found.guards, found.guards[0])
        return replace(found, values=values, guards=guards)


class OneSign(DoubleAngle):
    """As if one sign told its four branches apart."""

    def lower(  # type: ignore[override]
        self, g: ExpressionGraph, sigma: Expr, tolerances: Tolerances
    ) -> LoweredForm:
        return LoweredForm((sigma, g.zero), Divisor(g.one), None, 2)


class Fewer(DoubleAngle):
    """Without guards of two of its branches."""

    def lower(self, g: ExpressionGraph, sigma: Expr, tolerances: Tolerances) -> LoweredBranches:
        found = DoubleAngle.lower(self, g, sigma, tolerances)
        return replace(found, guards=found.guards[:2])


def leaf(form: type[Form]) -> Leaf:
    """The example's leaf, with another form of the same coefficients."""

    def find(
        equations: Sequence[PolynomialEquation], unknown: Variable, knowledge: Knowledge
    ) -> list[Candidate]:
        found = EXAMPLE.DOUBLE_ANGLE.find(equations, unknown, knowledge)
        return [replace(one, form=form(*one.coefficients)) for one in found]

    return Leaf(form.name, find)


@pytest.fixture
def twist(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Callable[[type[Form]], Request]:
    """The arm, whose turn a leaf with this form solves."""

    def request(form: type[Form]) -> Request:
        own = [one for one in LEAVES if one.name not in ("quartic", "trigonometric polynomial")]
        monkeypatch.setattr(leaves, "LEAVES", (*own, leaf(form)))
        monkeypatch.setattr("ikgen.tasks.TASKS", (*TASKS, REACH))
        path = tmp_path / "twist.urdf"
        path.write_text(TWIST)
        return Request(path, task="reach")

    return request


@pytest.mark.parametrize(("form", "most"), [(DoubleAngle, 4), (Twice, 8)])
def test_all_branches_are_emitted_and_verified(
    form: type[Form],
    most: int,
    twist: Callable[[type[Form]], Request],
    tmp_path: Path,
) -> None:
    languages = ("python",) if NO_COMPILER else ("python", "cpp")
    made = generate(twist(form), Outputs(languages, tmp_path / "out", samples=200))
    assert [step.branches for step in made.derivation.graph.steps] == [form.branches, 1]
    assert made.derivation.module.program.max_solutions == most
    assert all(report.passed for report in made.reports.values()) and made.reports
    arm = import_text((tmp_path / "out/twist_ik.py").read_text(), tmp_path)
    found = arm.solve(arm.forward([0.2, 0.7])).q
    np.testing.assert_allclose(
        sorted(found[:, 1]), [0.7 - np.pi, -0.7, 0.7, np.pi - 0.7], atol=1e-9
    )


@pytest.mark.parametrize(
    ("form", "message"),
    [
        (OneSign, r"OneSign\) has 4 branches, of which one sign tells but two apart"),
        (Fewer, r"Fewer\) has 4 branches and gives 4 values and 2 guards"),
    ],
)
def test_branches_that_are_not_given_are_refused(
    form: type[Form],
    message: str,
    twist: Callable[[type[Form]], Request],
    tmp_path: Path,
) -> None:
    with pytest.raises(PlugInError, match=message) as refused:
        generate(twist(form), Outputs(("python",), tmp_path / "out"))
    assert "LoweredBranches" in refused.value.hint
    assert not (tmp_path / "out").exists()


def evaluated(e: Expr, signs: Mapping[int, float]) -> float:
    """An expression of signs alone: a condition is 1 where it holds."""
    if e.is_const:
        return e.value
    if e.id in signs:
        return signs[e.id]
    a, *others = (evaluated(x, signs) for x in e.args)
    if e.op == "select":
        return others[0] if a else others[1]
    one = others[0] if others else 0.0
    return float({"gt": a > one, "and": a and one, "or": a or one, "not": not a}[e.op])


@pytest.mark.parametrize("count", range(2, 10))
def test_signs_choose_each_branch_once(count: int) -> None:
    g = ExpressionGraph(1)
    form = DoubleAngle(g.one, g.one, g.one)
    values = tuple((g.const(float(k)), g.const(-float(k))) for k in range(count))
    signs = more_signs(g, 0, count)
    for guarded in (False, True):
        # where they are guarded, every other branch holds
        guards = tuple(g.const(float(k % 2)) if guarded else None for k in range(count))
        given = LoweredBranches(values, Divisor(g.one), guards)
        one = type("Counted", (DoubleAngle,), {"branches": count})(*form.coefficients)
        (chosen,) = as_one_each(g, [one], [given], signs)
        found = []
        for row in product((1.0, -1.0), repeat=len(signs)):
            known = {sign.id: x for sign, x in zip(signs, row, strict=True)}
            if chosen.guard is None or evaluated(chosen.guard, known):
                found.append([evaluated(x, known) for x in chosen.values])
        expected = [float(k) for k in range(count) if not guarded or k % 2]
        assert found == [[k, -k] for k in expected]
        assert chosen.branches == count
