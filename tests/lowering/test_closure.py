"""The bound of what a row may be off its pose."""

from __future__ import annotations

import numpy as np
import pytest
from tests.support.tables import table

from ikgen.lowering.closure import _bounded, _differences
from ikgen.lowering.placement import Placement, Requirement
from ikgen.solver.solve import solve_chain


def test_squares_are_bounded_by_the_tolerance_s_and_wider_where_digits_are_lost() -> None:
    work = Placement(solve_chain(table(("R", "0", 0.0, 0.0), ("P", "1", 0.0, 0.0))), 0.0)
    g, part = work.g, work.g.add(work.g.const(0.5), work.system.equations[0].left)
    for rough, tolerance in ((False, 1e-3), (True, 1e-5)):
        if rough:
            work.loses_digits = True
            work.note_fold(part, 1.0)
        _bounded(work, [part, part], tolerance)
        items = [item for level in work.levels for item in level.items]
        (guard,) = [item for item in items if isinstance(item, Requirement)][-1:]
        most, total = guard.condition.args
        assert guard.condition.op == "gt" and total is g.dot([part, part], [part, part])
        assert work.residuals[-1] is total
        if rough:
            _, most, plain = most.args
            assert plain.probe[0] == pytest.approx(tolerance**2)
            assert most.probe[0] == pytest.approx((1000.0 * tolerance) ** 2)
        else:
            assert most.probe[0] == pytest.approx(tolerance**2)
    _bounded(work, [], 1.0)
    assert len(work.residuals) == 2


def test_differences_that_vanish_or_are_not_read_are_left_out() -> None:
    work = Placement(solve_chain(table(("R", "0", 0.0, 0.0), ("P", "1", 0.0, 0.0))), 0.0)
    g, equation = work.g, work.system.equations[0]
    pose = equation.left if work.knowledge.known_expr(equation.left) else equation.right
    unread = g.atom("angle", "nobody", np.linspace(0.1, 0.9, g.probes), unknown=True)
    assert work.knowledge.known_expr(pose) and not work.knowledge.known_expr(unread)
    half = g.mul(g.const(0.5), pose)
    pairs = [(pose, pose), (pose, half), (unread, pose), (pose, unread), (half, g.const(2.0))]
    found = _differences(work, pairs)
    assert [e.id for e in found] == [g.sub(pose, half).id, g.sub(half, g.const(2.0)).id]
