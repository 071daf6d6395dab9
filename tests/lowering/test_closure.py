"""The bound of what a row may be off its pose."""

from __future__ import annotations

import numpy as np
import pytest
from tests.support.tables import table

from ikgen.lowering.closure import CHECK_TOLERANCE, _bounded, _differences, require_closure
from ikgen.lowering.placement import LoweredLevel, Placement, Requirement
from ikgen.program.statements import Comment
from ikgen.solver.solve import solve_chain


def two_joints() -> Placement:
    return Placement(solve_chain(table(("R", "0", 0.0, 0.0), ("P", "1", 0.0, 0.0))), 0.0)


def guards(work: Placement) -> list[Requirement]:
    items = [item for level in work.levels for item in level.items]
    return [item for item in items if isinstance(item, Requirement)]


def test_squares_are_bounded_by_the_tolerance_s() -> None:
    work = two_joints()
    g, part = work.g, work.g.add(work.g.const(0.5), work.system.equations[0].left)
    _bounded(work, [part, part], 1e-3, 2.0)
    (guard,) = guards(work)
    most, total = guard.condition.args
    assert guard.condition.op == "gt" and total is g.dot([part, part], [part, part])
    assert work.residuals == [total]
    assert most.probe[0] == pytest.approx(4e-6)
    _bounded(work, [], 1.0)
    assert len(work.residuals) == 1
    work.note_fold(part, 1.0)
    work.singular.append(g.binary("gt", g.const(0.1), part))
    _bounded(work, [part], 1e-5)
    _, wide, plain = guards(work)[-1].condition.args[0].args
    assert wide.probe[0] == pytest.approx(1e-4) and plain.probe[0] == pytest.approx(1e-10)


def test_where_digits_are_lost_all_along_a_double_root_widens_the_bound_further() -> None:
    """A vanishing divisor does not: its branches are starts without holding."""
    work = two_joints()
    g, part = work.g, work.g.add(work.g.const(0.5), work.system.equations[0].left)
    work.loses_digits = True
    work.note_fold(part, 1.0)
    _bounded(work, [part], 1e-5)
    close, wide, plain = guards(work)[-1].condition.args[0].args
    assert close is work.close[0]
    assert wide.probe[0] == pytest.approx(1.0) and plain.probe[0] == pytest.approx(1e-6)
    work.singular.append(g.binary("gt", g.const(0.1), part))
    _bounded(work, [part], 1e-5)
    singular, vanishing, other = guards(work)[-1].condition.args[0].args
    assert singular is work.singular[0] and vanishing.probe[0] == pytest.approx(1e-4)
    assert other.args[0] is close


@pytest.mark.parametrize(("loses_digits", "times"), [(False, 1.0), (True, 1000.0)])
def test_rows_may_be_off_more_where_an_unknown_may_have_lost_digits(
    monkeypatch: pytest.MonkeyPatch, loses_digits: bool, times: float
) -> None:
    """No matter whether a step of this pose is seen to: those after it multiply what it is off."""
    work = two_joints()
    work.loses_digits = loses_digits
    part = work.g.add(work.g.const(0.5), work.system.equations[0].left)
    monkeypatch.setattr("ikgen.lowering.closure._residuals", lambda *_: ([part], [part]))
    require_closure(work)
    bounds = [guard.condition.args[0].probe[0] for guard in guards(work)]
    assert bounds == pytest.approx([(times * CHECK_TOLERANCE) ** 2] * len(bounds)) and bounds
    (told,) = (item for item in work.levels[-1].items if isinstance(item, Comment))
    assert told.text == "does the row reproduce the pose?"


@pytest.mark.parametrize("dear", ["position", "rotation", "both"])
def test_the_split_that_costs_least_is_compared(monkeypatch: pytest.MonkeyPatch, dear: str) -> None:
    """Of position and rotation together."""
    work = two_joints()
    g, part = work.g, work.g.add(work.g.const(0.5), work.system.equations[0].left)
    costly = g.square(g.square(g.square(g.add(g.const(0.25), part))))
    looked_at: list[tuple[int, int]] = []

    def residuals(_: Placement, k: int, m: int) -> tuple[list, list]:
        looked_at.append((k, m))
        if (k, m) == (1, 2):
            return [part], [part]
        return [part] if dear == "rotation" else [costly], [part] if dear == "position" else [
            costly
        ]

    monkeypatch.setattr("ikgen.lowering.closure._residuals", residuals)
    require_closure(work)
    assert sorted(looked_at) == [(0, 1), (0, 2), (1, 2)]
    assert work.residuals == [g.square(part)] * 2


def test_differences_that_vanish_or_are_not_read_are_left_out() -> None:
    work = two_joints()
    g, equation = work.g, work.system.equations[0]
    pose = equation.left if work.knowledge.known_expr(equation.left) else equation.right
    unread = g.atom("angle", "nobody", np.linspace(0.1, 0.9, g.probes), unknown=True)
    assert work.knowledge.known_expr(pose) and not work.knowledge.known_expr(unread)
    half = g.mul(g.const(0.5), pose)
    pairs = [(pose, pose), (pose, half), (unread, pose), (pose, unread), (half, g.const(2.0))]
    found = _differences(work, pairs)
    assert [e.id for e in found] == [g.sub(pose, half).id, g.sub(half, g.const(2.0)).id]


def test_an_unknown_is_not_compared_with_what_it_was_solved_from() -> None:
    work = two_joints()
    g = work.g
    x, y = (g.atom("pose", key, np.linspace(0.1, 0.9, g.probes) ** k, unknown=False)
            for k, key in enumerate(("one", "other"), start=1))  # fmt: skip
    solved = g.atom("pose", "solved", np.linspace(0.1, 0.9, g.probes), unknown=False)
    work.definition[solved.id] = g.sub(x, y)
    same = [(solved, g.sub(x, y)), (g.sub(y, x), g.neg(solved)), (g.neg(solved), g.sub(y, x))]
    assert not _differences(work, same)
    assert len(_differences(work, [(g.neg(solved), g.sub(x, y)), (solved, g.sub(y, x))])) == 2


def test_norms_are_bounded_at_the_level_that_they_are_of(monkeypatch: pytest.MonkeyPatch) -> None:
    work = two_joints()
    g, part = work.g, work.g.add(work.g.const(0.5), work.system.equations[0].left)
    sigma = g.atom("sigma", "0", np.ones(g.probes), unknown=False)
    work.levels.append(LoweredLevel(2, sigma))
    work.level_of[sigma.id] = len(work.levels) - 1
    outer, inner = g.square(part), g.binary("max", part, sigma)
    work.norms += [outer, inner]
    monkeypatch.setattr("ikgen.lowering.closure._residuals", lambda *_: ([], []))
    require_closure(work)
    assert work.residuals == [g.square(outer), g.square(inner)]
    held = [[i for i in level.items if isinstance(i, Requirement)] for level in work.levels]
    assert [len(items) for items in held] == [1] + [0] * (len(held) - 2) + [1]
