"""The table of times of Python modules, and what they are of."""

from __future__ import annotations

from types import ModuleType

import numpy as np
import pytest
from benchmarks.python_speed import Timed, counted, kind_of, reachable, table, timed_module
from tests.support.cpp_modules import solver_module
from tests.support.solving import import_text

from ikgen.emit.python.python_emitter import emit_module

pytestmark = pytest.mark.usefixtures("solved_once")


@pytest.fixture(scope="module", params=["ur5e", "doosan_m1013"])
def arm(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    text = emit_module(solver_module(request.param))
    return import_text(text, tmp_path_factory.mktemp(request.param))


def test_times_above_the_goals_are_marked() -> None:
    slow = Timed("slow", "rounded", 151.0, 5.9, (50.0, 2.0), (3.0, 4.0), 3.0, 1.0)
    fast = Timed("fast", "elimination", 1199.0, 121.0, (50.0, 2.0), (0.0, 0.0))
    _, one, other = (line.split() for line in table([slow, fast]))
    assert one == ["slow", "rounded", "151*", "50", "5.9", "2.0", "3.0", "4.0", "3.00*", "1.00"]
    assert other[2:6] == ["1199", "50", "121.0*", "2.0"] and len(other) == 8


def test_a_module_is_timed_beside_an_exact_one(arm: ModuleType) -> None:
    found = timed_module("arm", arm, arm, 100)
    assert found.kind == kind_of(arm) == ("exact" if arm._ARM.together is None else "rounded")
    assert 0.5 < found.scalar / found.exact[0] < 2.0 and found.batch < found.scalar


def test_poses_that_take_care_are_counted(arm: ModuleType) -> None:
    poses = reachable(arm, 50)
    assert all(len(arm.solve(pose)) for pose in poses)
    straight = np.array([0.3, -0.9, 1.1, 0.4, 0.0, -0.2])
    for run in (lambda T: arm.solve_batch(T[None]), arm.solve):
        with counted(arm) as counts:
            run(arm.forward(straight))
            run(arm.forward(straight + 0.4))
        assert counts == [1]
    assert arm._placed_rows.__name__ != "counting"
