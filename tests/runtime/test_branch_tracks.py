"""What may happen to rows between two samples of a held joint: limits, and ways to folds."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest

from ikgen.runtime.python.branch_tracks import _SAFETY, _limit_crossings, _reach

ARM = SimpleNamespace(
    moving=(0,),
    lower=np.array([-1.0]),
    upper=np.array([3.0]),
    chain=SimpleNamespace(revolute=(True,)),
    policy=SimpleNamespace(limit_tolerance=1e-9),
)


@pytest.mark.parametrize(
    ("start", "change", "bend", "dead", "count"),
    [
        (1.2, 0.3, 0.01, False, 0),  # inside at both ends
        (2.9, 0.3, 0.01, False, 1),  # out by one limit
        (2.9 - 2.0 * math.pi, 0.3, 0.01, False, 1),  # the same on another turn
        (3.5, 0.3, 0.01, True, 0),  # outside all over
        (2.98, 0.04, 0.03, False, 2),  # bent so much that it may go out and come back
        (2.9, 0.05, 0.2, False, 2),  # inside at both ends, and may be out between them
        (-1.3, 0.2, 0.01, True, 0),
        (3.2, 1.9, 0.01, True, 0),  # outside, past the far side of the turn
    ],
)
def test_limits_that_may_be_crossed(
    start: float, change: float, bend: float, dead: bool, count: int
) -> None:
    linked = np.ones((1, 1), dtype=bool)
    q, way, off = (np.full((1, 1, 1), x) for x in (start, change, bend))
    found = _limit_crossings(ARM, q, way, off, linked, True)
    assert bool(found[0][0, 0]) == dead
    if not dead:
        assert found[1][0, 0] == count
    free = _limit_crossings(ARM, q, way, off, linked, False)
    assert not free[0].any() and not free[1].any()


@pytest.mark.parametrize("where", [0, 1])
def test_the_way_to_a_fold_grows_as_the_root_of_the_distance(where: int) -> None:
    """q - q_fold = sqrt(h - h_fold), the fold at the far end of the cell: its own way over the other's."""
    own, beside = np.array([0.2, 0.5]), np.array([0.3, 0.1])
    reach = _reach(own, beside, where)
    assert reach[-1 if where else 0] == 1.0
    shares = np.sqrt(own) / (np.sqrt(own + beside) - np.sqrt(own))
    most = reach[:-1] if where else reach[1:]
    assert (most >= shares).all() and (most <= _SAFETY * shares).all()
