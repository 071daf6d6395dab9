"""Five joints with rounded right angles: rows of continua are flagged, those where branches meet need not
be, and of poses at random none is."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.both_languages import header_of
from tests.support.rolling_forearm import FLAT_FOLDS, forearm_file, forearm_under_test
from tests.support.solving import NO_COMPILER

from ikgen.derivation.derive import derive
from ikgen.emit.python.python_emitter import emit_module
from ikgen.records.request import Request
from ikgen.verify.arm import ArmUnderTest
from ikgen.verify.checks import check_singular_flags
from ikgen.verify.runners.python_module import PythonModule
from ikgen.verify.runners.runner import Runner
from ikgen.verify.sampling import SampleSet
from ikgen.verify.singularities import on_continuum, singular_configurations
from ikgen.verify.trials import Trial, run_trial

pytestmark = [
    pytest.mark.usefixtures("solved_once"),
    pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER or "compiles"),
]

Case = tuple[ArmUnderTest, tuple[Runner, ...]]


def in_both(axis: str, folder: Path) -> Case:
    """The arm, and its solvers in Python and C++."""
    path = forearm_file(folder / "forearm.urdf")
    request = Request(path, name="forearm", task="position-direction", tool_axis=axis)
    module = derive(request).module
    python = folder / "forearm_ik.py"
    python.write_text(emit_module(module))
    return forearm_under_test(path, axis), (PythonModule(python), header_of(module, folder))


def answered(case: Case, q: NDArray[np.float64]) -> list[Trial]:
    """What each language answers to the poses of configurations (N, dof)."""
    arm, runners = case
    sample = SampleSet("made", q, arm.oracle.forward(q), arm.sigma(q))
    return [run_trial(runner, arm, sample, limits=False) for runner in runners]


@pytest.mark.long
@pytest.mark.parametrize("axis", FLAT_FOLDS)
def test_rows_where_branches_meet_pass_and_rows_at_random_are_not_flagged(
    tmp_path: Path, axis: str
) -> None:
    case = in_both(axis, tmp_path)
    for trial in answered(case, np.array(FLAT_FOLDS[axis])):
        assert (trial.rows.count > 0).all()
        assert check_singular_flags(case[0], [trial]).passed
    for trial in answered(case, case[0].uniform(np.random.default_rng(3), 20_000)):
        assert (trial.rows.count > 0).all() and not trial.rows.singular.any()


@pytest.mark.long
def test_rows_of_continua_are_flagged_and_fail_where_they_are_not(tmp_path: Path) -> None:
    case = in_both("z", tmp_path)
    arm = case[0]
    q = singular_configurations(arm, 300, np.random.default_rng(0))
    q = q[on_continuum(arm, q, arm.oracle.forward(q))]
    assert len(q) > 20
    for trial in answered(case, q):
        assert trial.rows.singular.any(axis=1).all()
        assert check_singular_flags(arm, [trial]).passed
        silent = replace(trial.rows, singular=np.zeros_like(trial.rows.singular))
        found = check_singular_flags(arm, [replace(trial, rows=silent)])
        assert not found.passed and found.failures >= len(q) // 2
