"""Where continua that the arm has go on inside the limits."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.cpp_modules import solver_module as published_module
from tests.support.solving import import_text

from ikgen.emit.python.python_emitter import emit_module
from ikgen.runtime.python.arm.chain_kinematics import forward
from ikgen.runtime.python.arm.limit_margins import outside
from ikgen.runtime.python.singular import limit_curves
from ikgen.runtime.python.singular.limit_curves import rows_along

Array = NDArray[np.float64]
AT = np.array([0.2, -0.9, 1.1, 3.3, 0.0, -0.4])
"""Joint 4, outside its limits, goes on as joint 6 goes back."""


@pytest.fixture(scope="module")
def arm(tmp_path_factory: pytest.TempPathFactory) -> Any:
    text = emit_module(published_module("kuka_kr6r900sixx"))
    return import_text(text, tmp_path_factory.mktemp("arm"))._ARM


def test_a_row_is_right_though_its_sample_did_not_converge(
    arm: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    least_outside = limit_curves._least_outside

    def beside(*given: Any) -> tuple[Array, Array]:
        off, rows = least_outside(*given)
        return off, rows + 1e-6

    monkeypatch.setattr(limit_curves, "_least_outside", beside)
    pose = forward(arm.chain, AT)[None]
    owner, rows = rows_along(arm, AT[None], pose, [])
    assert owner.tolist() == [0]
    assert np.abs(forward(arm.chain, rows[0]) - pose[0]).max() < 1e-9
    assert outside(arm, rows, True)[0] < 1e-5


def test_none_is_taken_where_one_on_it_stands_for_the_continuum(arm: Any) -> None:
    pose = forward(arm.chain, AT)[None]
    on = AT + 2.0 * (np.eye(6)[5] - np.eye(6)[3])
    for row, count in ((on, 0), (on + 0.1 * np.eye(6)[0], 1)):
        assert len(rows_along(arm, AT[None], pose, [(0, tuple(row.tolist()))])[0]) == count


def test_solutions_on_one_continuum_have_one_row(arm: Any) -> None:
    pose = forward(arm.chain, AT)[None]
    on = AT - 0.7 * (np.eye(6)[5] - np.eye(6)[3])
    both, aims = np.array([AT, on]), np.concatenate([pose, pose])
    assert rows_along(arm, both, aims, [])[0].tolist() == [0]
    stands = [(1, tuple((on + 0.3 * (np.eye(6)[3] - np.eye(6)[5])).tolist()))]
    assert len(rows_along(arm, both, aims, stands)[0]) == 0
    other = AT + np.eye(6)[0]  # the same continuum of another pose
    both, aims = np.array([AT, other]), np.concatenate([pose, forward(arm.chain, other)[None]])
    assert rows_along(arm, both, aims, [])[0].tolist() == [0, 1]
    assert rows_along(arm, both, aims, [(0, tuple(on.tolist()))])[0].tolist() == [1]
