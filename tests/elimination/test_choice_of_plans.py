"""Which eliminations are kept does not hang on the last bits of what probing measures."""

from __future__ import annotations

import numpy as np
import pytest

from ikgen.elimination.plan import _separate, ranking


@pytest.mark.parametrize("seed", range(5))
def test_half_a_digit_of_noise_changes_no_order(seed: int) -> None:
    """Mirrored eliminations, whose errors are alike; one that is worse, one that loses solutions."""
    noise = np.random.default_rng(seed).uniform(-0.25, 0.25, 7)
    rough = np.array([-3.0, -6.4, -6.5, -9.3, -6.2, -9.9, -12.0]) + noise
    hits = np.ones((7, 200), dtype=bool)
    hits[6, :20] = False
    assert ranking(hits, rough)[:2] == [3, 5]
    assert ranking(hits[:5], rough[:5]) == [3, 1]
    shifts = 10.0 ** np.array([-2.0, -11.6, -8.0, -11.9, -11.8, -3.0]) * 10.0 ** noise[:6]
    assert _separate(shifts) == [1, 3]


def test_only_what_separates_roots_is_kept() -> None:
    assert _separate(np.array([1.0, 2e-4, 3e-5, 1.0])) == [2]
    assert _separate(np.ones(4)) == []
