"""Which rows are refined, by how the arm is solved and how far its file is off what was solved."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest
from tests.support.module_facts import module_around

from ikgen.program.policy import SolvePolicy


@pytest.mark.parametrize(
    ("deviation", "plan", "rounded", "rough", "far"),
    [
        (0.0, None, False, True, False),
        (1e-5, None, True, False, False),
        (1e-3, None, True, False, True),
        (1e-3, object(), False, False, False),
        (0.0, object(), False, False, False),
    ],
)
def test_rows_of_rounded_files_are_refined(
    deviation: float, plan: object, rounded: bool, rough: bool, far: bool
) -> None:
    dh = chain_facts(deviation=(0.0, deviation))
    module = module_around(None, dh, plan=plan)
    policy = SolvePolicy()
    assert (module.rounded, module.tells_rough, module.far) == (rounded, rough, far)
    near = policy.fold * math.sqrt(deviation)
    assert module.policy.fold_reach == pytest.approx(max(policy.fold_reach, near))
    beside = policy.anywhere if far else near
    assert module.policy.beside_reach == pytest.approx(beside)
    assert module.policy.limit_tolerance == policy.limit_tolerance


def chain_facts(
    *, deviation: tuple[float, float] = (0.0, 0.0), most_driven: float = 1.0, away: float = 0.0
) -> SimpleNamespace:
    """What policies need to know of an arm that stands `away` m from the frame of its poses."""
    base, link = np.eye(4), np.eye(4)
    base[1, 3], link[0, 3] = away, 0.5
    joints = [SimpleNamespace(kind="revolute", limits=SimpleNamespace(lower=-1.0, upper=1.0))]
    return SimpleNamespace(
        deviation=deviation, most_driven=most_driven, held=(), symbols=(), dof=1, rows=(),
        file_frames=(base, link), joints=joints,
    )  # fmt: skip


def test_what_moves_the_tool_farther_is_put_on_limits_from_less_far() -> None:
    plain = SolvePolicy().limit_tolerance
    assert module_around(None, chain_facts(most_driven=4.0)).policy.limit_tolerance == plain / 4.0


def test_what_stands_far_away_is_exact_to_the_digits_that_leaves() -> None:
    """Rows are tried on limits that are exact there: 5 km away a double has 1e-12 m."""
    plain = SolvePolicy()
    for away, least in ((0.0, 1e-12), (200.0, 1e-12), (5e3, 2e-11)):
        policy = module_around(None, chain_facts(away=away)).policy
        assert policy.exact == pytest.approx(least)
        assert policy.limit_tolerance == plain.limit_tolerance


def test_joints_of_large_arms_are_put_on_limits_from_less_far(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("ikgen.emit.solver_module.position_unit", lambda dh: 2.5)
    plain = SolvePolicy().limit_tolerance
    assert module_around(None, chain_facts()).policy.limit_tolerance == plain / 2.5
