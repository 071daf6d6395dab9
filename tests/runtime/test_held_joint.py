"""Rows at many values of what is held."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.support.held_arms import held_limits, imported


@pytest.mark.parametrize(
    ("name", "guards"), [("shoulder_elbow_wrist", True), ("rounded_arm_angle", False)]
)
def test_many_values_give_what_a_few_at_a_time_give(
    name: str, guards: bool, tmp_path: Path
) -> None:
    """More than the closed form takes at once."""
    arm = imported(name, tmp_path)
    T = arm.forward(np.array([0.3, 0.5, -0.4, 1.1, 0.2, 0.8, -0.3]))
    held = np.linspace(*held_limits(arm), 2500)
    whole = arm._rows_at(arm._HELD, T, held)
    parts = [arm._rows_at(arm._HELD, T, held[k : k + 500]) for k in range(0, len(held), 500)]
    real = np.concatenate([part.real for part in parts])
    folds = np.concatenate([part.folds for part in parts])
    assert np.isfinite(folds).any() == guards
    np.testing.assert_array_equal(whole.real, real)
    np.testing.assert_array_equal(whole.folds, folds)
    rows = np.concatenate([part.q for part in parts])
    np.testing.assert_allclose(whole.q[real], rows[real], atol=1e-11)
    assert real.any(axis=1).mean() > 0.3
