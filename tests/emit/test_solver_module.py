"""Which rows are refined, by how the arm is solved and how far its file is off what was solved."""

from __future__ import annotations

import math
from types import SimpleNamespace

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
    dh = SimpleNamespace(deviation=(0.0, deviation), most_driven=1.0, held=())
    module = module_around(None, dh, plan=plan)
    policy = SolvePolicy()
    assert (module.rounded, module.tells_rough, module.far) == (rounded, rough, far)
    near = policy.fold * math.sqrt(deviation)
    assert module.policy.fold_reach == pytest.approx(max(policy.fold_reach, near))
    beside = policy.anywhere if far else near
    assert module.policy.beside_reach == pytest.approx(beside)
    assert module.policy.limit_tolerance == policy.limit_tolerance


def test_a_joint_that_moves_the_tool_several_times_as_far_is_put_on_limits_from_less_far() -> None:
    dh = SimpleNamespace(deviation=(0.0, 0.0), most_driven=4.0, held=())
    module = module_around(None, dh)
    assert module.policy.limit_tolerance == SolvePolicy().limit_tolerance / 4.0
