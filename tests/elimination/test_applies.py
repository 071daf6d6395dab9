"""Which chains the elimination solves, and in what lengths."""

from __future__ import annotations

from tests.support.tables import table

from ikgen.elimination.applies import elimination_plan
from ikgen.elimination.loop_frames import held_frames, typical_length
from ikgen.kinematics.position_unit import position_unit


def test_lengths_count_over_no_more_than_the_arm_reaches() -> None:
    """Frames that lie 50 m out along parallel axes would leave rows right to 50 nm."""
    rows = [
        ("R", "0", 0.0, 0.0),
        ("R", "1", 0.1, 0.2),
        ("R", "0", 0.4, 50.0),
        ("R", "0", 0.3, -50.0),
    ]
    far = table(*rows, ("R", "1", 0.1, 0.1), ("R", "1", 0.05, 0.1))
    plan = elimination_plan(far)
    assert plan is not None and position_unit(far) < 2.0
    assert plan.length == 2.0 * position_unit(far) < 0.1 * typical_length(held_frames(far))
    rows[2:] = [
        ("R", "0", 0.4, 0.1),
        ("R", "0", 0.3, 0.0),
        ("R", "1", 0.1, 0.1),
        ("R", "1", 0.05, 0.1),
    ]
    near = table(*rows)
    plan = elimination_plan(near)
    assert plan is not None and plan.length == typical_length(held_frames(near))
