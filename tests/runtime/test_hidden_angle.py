"""Linear equations at many hidden angles at once."""

from __future__ import annotations

import numpy as np

from ikgen.runtime.python.hidden_angle import solved


def test_a_singular_matrix_changes_nothing_beside_it() -> None:
    random = np.random.default_rng(3)
    pivot, N = random.normal(size=(5, 12, 12)), random.normal(size=(5, 12, 8))
    pivot[2, :, 4] = 0.0
    found = solved(pivot, N)
    assert np.isfinite(found).all()
    for i in range(5):
        np.testing.assert_array_equal(found[i], solved(pivot[i : i + 1], N[i : i + 1])[0])
    regular = [0, 1, 3, 4]
    assert np.abs(pivot[regular] @ found[regular] - N[regular]).max() < 1e-12
