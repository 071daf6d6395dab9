"""Constants of rows by least squares."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.support.rounded_arms import spherical_wrist

from ikgen.kinematics.forward import file_forward
from ikgen.kinematics.modified_dh import to_dh
from ikgen.kinematics.nearest import end_motions, fit_rows
from ikgen.model.dh import Length


def test_changes_are_found() -> None:
    dh = to_dh(spherical_wrist(np.pi / 2))
    name = dh.rows[2].a.name
    off = replace(dh.rows[2], a=Length(dh.rows[2].a.value - 1e-3, name))
    moved = replace(dh, rows=(*dh.rows[:2], off, *dh.rows[3:]))
    constants = ((1, "alpha"), (2, "a"), (3, "theta"))
    found = fit_rows(moved, constants).change
    assert found[2, "a"] == pytest.approx(1e-3, abs=1e-14)
    assert abs(found[1, "alpha"]) < 1e-14
    assert abs(found[3, "theta"]) < 1e-14


def test_first_of_constants_that_stand_in_for_each_other_changes() -> None:
    dh = to_dh(spherical_wrist())
    constants = tuple((i, "theta") for i in range(6))
    change = fit_rows(dh, (*constants, *end_motions(dh))).change
    assert change[-1, "Rz"] == 0.0
    assert change[6, "Rz"] == 0.0


def test_end_takes_what_the_rows_cannot() -> None:
    dh = to_dh(spherical_wrist(np.pi / 2))
    away = np.eye(4)
    away[:3, 3] = 1e-4, 2e-4, -3e-4
    moved = replace(dh, file_frames=(away @ dh.file_frames[0], *dh.file_frames[1:]))
    fitted = fit_rows(moved, end_motions(dh))
    np.testing.assert_allclose(fitted.X_base, away @ dh.X_base, atol=1e-14)
    np.testing.assert_allclose(fitted.X_tip, dh.X_tip, atol=1e-14)
    q = np.zeros(6)
    assert not np.allclose(file_forward(moved, q), file_forward(dh, q), atol=1e-5)
