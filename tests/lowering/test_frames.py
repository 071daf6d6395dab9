"""The file's frames as operands: numbers, or names that give the table's link."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.support.tables import table

from ikgen.kinematics.rigid import rotation_x, rotation_z
from ikgen.lowering.frames import file_frames
from ikgen.model.dh import Angle, Length
from ikgen.program.interpret import evaluate
from ikgen.program.ops import Op
from ikgen.program.statements import Entries

DH = table(("R", "0", 0.0, 0.1), ("R", "1", 0.4, 0.0), ("P", "-1", 0.3, 0.0))


def numbers(frame: Entries, names: dict[str, float]) -> np.ndarray:
    """A frame's numbers (3, 4)."""
    return np.array([[evaluate(x, names) for x in row] for row in frame])


def test_frames_with_numbers_are_the_file_s() -> None:
    found = file_frames(DH)
    assert len(found) == len(DH.rows) + 1
    for frame, expected in zip(found, DH.file_frames, strict=True):
        np.testing.assert_array_equal(numbers(frame, {}), expected[:3])


@pytest.mark.parametrize("sign", [1, -1])
def test_a_row_without_numbers_is_its_link_in_names(sign: int) -> None:
    alpha = Angle(0.6, None, "alpha_1", symbolic=True)
    a = Length(sign * 0.25, "a_1", sign, symbolic=True)
    rows = (
        DH.rows[0],
        replace(DH.rows[1], alpha=alpha, a=a, d=replace(a, name="d_2")),
        *DH.rows[2:],
    )
    found = file_frames(replace(DH, rows=rows))
    names = {"cos_alpha_1": np.cos(1.1), "sin_alpha_1": np.sin(1.1), "a_1": 0.7, "d_2": -0.2}
    link, after = np.eye(4), np.eye(4)
    link[:3, :3], link[0, 3], after[2, 3] = rotation_x(1.1), sign * 0.7, sign * -0.2
    np.testing.assert_allclose(numbers(found[1], names), (link @ after)[:3], atol=1e-15)
    np.testing.assert_array_equal(numbers(found[2], {}), DH.file_frames[2][:3])


def test_the_base_stands_before_the_lead_row() -> None:
    base = np.eye(4)
    base[:3, :3], base[:3, 3] = rotation_z(0.4), (0.1, 0.2, 0.3)
    rows = (replace(DH.rows[0], d=Length(0.1, "d_1", symbolic=True)), *DH.rows[1:])
    found = file_frames(replace(DH, rows=rows, X_base=base))
    up = np.eye(4)
    up[2, 3] = 0.9
    np.testing.assert_allclose(numbers(found[0], {"d_1": 0.9}), (base @ up)[:3], atol=1e-15)
    assert any(isinstance(x, Op | str) for row in found[0] for x in row)
