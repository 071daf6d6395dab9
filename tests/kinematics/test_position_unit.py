"""What errors of a tip's position are relative to."""

from __future__ import annotations

import pytest
from tests.support.tables import table

from ikgen.kinematics.position_unit import position_unit


def test_it_is_the_longest_link_and_a_metre_for_small_arms() -> None:
    assert position_unit(table(("R", "0", 0.2, 0.0), ("R", "1", 0.3, 0.1))) == 1.0
    assert position_unit(table(("R", "0", 2.25, 0.0), ("R", "1", 1.5, 0.5))) == 2.25
    assert position_unit(table(("P", "0", 0.0, 0.0), ("R", "1", 3.0, 0.0))) == pytest.approx(3.0)


def test_frames_far_out_along_axes_do_not_count() -> None:
    """Offsets of 50 m to and fro along parallel axes, of an arm that reaches 1.7 m."""
    far = table(("R", "0", 0.3, 50.0), ("R", "0", 1.2, -50.0), ("R", "1", 0.2, 0.0))
    assert position_unit(far) == pytest.approx(1.5, abs=0.31)
