"""The joints whose angular velocities span all directions, for an elimination by blocks."""

from __future__ import annotations

import numpy as np
from tests.support.chains import make_chain, translation
from tests.support.rounded_arms import X, Z, spherical_wrist, three_parallel

from ikgen.kinematics.column_blocks import column_blocks
from ikgen.kinematics.modified_dh import to_dh

Y = [0.0, 1.0, 0.0]
STEPS = [translation(0.0, 0.1, 0.3), translation(0.3, 0.0, 0.1), translation(0.0, 0.2, 0.0)]


def test_the_last_three_axes_span_a_wrist() -> None:
    for arm in (spherical_wrist(), three_parallel()):
        assert column_blocks(to_dh(arm), range(6), 1.0) == (0, 1, 2, 3, 4, 5)


def test_a_shoulder_of_meeting_axes_goes_last() -> None:
    none = translation(0.0, 0.0, 0.0)
    shoulder = make_chain("RRRPPP", [none, none, none, *STEPS], [Z, X, Z, X, Y, Z], none)
    assert column_blocks(to_dh(shoulder), range(6), 1.0) == (3, 4, 5, 0, 1, 2)


def test_two_directions_of_axes_are_no_block() -> None:
    planar = make_chain("RRRPPP", [STEPS[0], *STEPS[:2], *STEPS], [Z, Z, X, X, Y, Z], np.eye(4))
    found = column_blocks(to_dh(planar), range(6), 1.0)
    assert not found or set(found[3:]) == {0, 1, 2}
    assert column_blocks(to_dh(planar), range(5), 1.0) == ()
