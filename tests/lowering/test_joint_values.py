"""A joint's value to its DH variable and back: offsets, signs, ratios, sliding joints."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.lowering.frames import operand_of
from ikgen.lowering.joint_values import joint_expression, variable_lets
from ikgen.model.chain import PRISMATIC, REVOLUTE
from ikgen.model.dh import Angle, DHRow, Length
from ikgen.program.interpret import evaluate

ZERO = Angle(0.0, Fraction(0))
NONE = Length(0.0, None)
OFFSETS = (0.0, math.pi / 2, -math.pi, 0.7)


def row(kind: str, scale: float, offset: float) -> DHRow:
    """A row whose variable is `scale * q + offset`."""
    shift = Angle(offset, None) if kind == REVOLUTE else Length(offset, None)
    return DHRow("q", kind, ZERO, NONE, NONE, ZERO, 0, scale, shift)


def variable(r: DHRow, q: float) -> tuple[float, ...]:
    """What the statements make of the joint's value."""
    names = ("c", "s") if r.revolute else ("d",)
    known = {"given": q}
    for let in variable_lets(r, "given", names):
        assert let.name not in known
        known[let.name] = evaluate(let.value, known)
    return tuple(known[name] for name in names)


def value(r: DHRow, v: tuple[float, ...]) -> float:
    """The joint's value from its variable, by the expression that is lowered."""
    g = ExpressionGraph(1)
    names = ("c", "s")[: len(v)]
    atoms = [
        g.atom("input", n, np.array([x]), unknown=False) for n, x in zip(names, v, strict=True)
    ]
    node = joint_expression(g, r, tuple(atoms))
    by_operand = evaluate(operand_of(node), dict(zip(names, v, strict=True)))
    assert abs(by_operand - node.probe[0]) < 1e-12
    return by_operand


@settings(deadline=None, max_examples=40)
@given(st.floats(-math.pi, math.pi))
@pytest.mark.parametrize("offset", OFFSETS)
@pytest.mark.parametrize("scale", [1.0, -1.0, 2.0, -2.0])
def test_angles_go_there_and_back(scale: float, offset: float, q: float) -> None:
    r = row(REVOLUTE, scale, offset)
    c, s = variable(r, q)
    assert abs(c - math.cos(scale * q + offset)) < 1e-12
    assert abs(s - math.sin(scale * q + offset)) < 1e-12
    back = value(r, (2.5 * c, 2.5 * s))  # the pair need not be normalized
    period = 2 * math.pi / abs(scale)
    assert abs((back - q + period / 2) % period - period / 2) < 1e-12
    assert -period / 2 - 1e-12 < back <= period / 2 + 1e-12


@settings(deadline=None, max_examples=40)
@given(st.floats(-3.0, 3.0))
@pytest.mark.parametrize("offset", [0.0, 0.25, -0.4])
@pytest.mark.parametrize("scale", [1.0, -1.0, 2.0, -0.5])
def test_lengths_go_there_and_back(scale: float, offset: float, q: float) -> None:
    r = row(PRISMATIC, scale, offset)
    (d,) = variable(r, q)
    assert abs(d - (scale * q + offset)) < 1e-12
    assert abs(value(r, (d,)) - q) < 1e-12


@pytest.mark.parametrize("scale", [0.5, -0.5, 0.25, -3.0])
def test_only_the_sign_of_a_ratio_mirrors(scale: float) -> None:
    r = row(REVOLUTE, scale, 0.2)
    for q in (-0.9, 0.1, 1.0):
        assert abs(value(r, variable(r, q)) - q) < 1e-12


def test_a_plain_joint_costs_nothing() -> None:
    assert [let.value for let in variable_lets(row(PRISMATIC, 1.0, 0.0), "given", ("d",))] == [
        "given"
    ]
    assert len(variable_lets(row(REVOLUTE, 1.0, 0.0), "given", ("c", "s"))) == 2
    assert value(row(REVOLUTE, 1.0, 0.0), (-1.0, 0.0)) == math.pi


def test_the_first_row_that_a_joint_drives_is_its_own() -> None:
    from tests.support.tables import table

    dh = table(("R", "0", 0.0, 0.0), ("R", "1", 0.0, 0.0))
    assert dh.lead_row(1) is dh.rows[1]
