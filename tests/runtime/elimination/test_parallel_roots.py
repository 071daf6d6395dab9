"""The hidden angle of loops with parallel axes, from values of its polynomial."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.parallel_arms import parallel_frames

from ikgen.runtime.python.elimination import parallel_axes
from ikgen.runtime.python.elimination.parallel_axes import _TABLES, _real_roots, parallel_candidates
from ikgen.runtime.python.elimination.parallel_links import MEETING, PLAIN, UPRIGHT

Array = NDArray[np.float64]


@pytest.mark.parametrize(("kind", "degree"), [(PLAIN, 4), (UPRIGHT, 8), (MEETING, 8)])
def test_real_roots_are_found_from_values_at_the_nodes(kind: int, degree: int) -> None:
    nodes, _ = _TABLES[kind]
    assert len(nodes) == 2 * degree + 2
    rng = np.random.default_rng(degree)
    wanted = np.linspace(-3.0, 2.9, 2 * degree) + rng.uniform(-0.1, 0.1, (5, 2 * degree))
    f = np.sin(0.5 * (nodes - wanted[:, :, None])).prod(axis=1)
    pose, angle, least, clear = _real_roots(kind, f, np.full((5, 1), 1e-3))
    assert pose.tolist() == np.repeat(np.arange(5), 2 * degree).tolist()
    found = np.remainder(angle + np.pi, 2.0 * np.pi) - np.pi
    np.testing.assert_allclose(np.sort(found.reshape(5, -1), axis=1), wanted, atol=1e-7)
    assert least.tolist() == [2 * degree] * 5 and clear.all()


@pytest.mark.parametrize("kind", [PLAIN, UPRIGHT, MEETING])
@pytest.mark.parametrize("off", [0.0, 1e-12, 1e-6, 1e-4])
def test_roots_are_doubtful_that_deviations_may_have_taken_apart(
    monkeypatch: pytest.MonkeyPatch, kind: int, off: float
) -> None:
    """By forty times the root of what the links deviate, halves of double ones."""
    seen: list[Array] = []

    def roots(kind: int, f: Array, doubtful: Array) -> Any:
        seen.append(doubtful)
        none = np.zeros(0, dtype=np.intp)
        return none, np.zeros(0), np.zeros(len(f), dtype=np.intp), np.ones(len(f), dtype=bool)

    monkeypatch.setattr(parallel_axes, "_real_roots", roots)
    monkeypatch.setattr(parallel_axes, "deviation", lambda kind, of: np.full((1, 1), off))
    frames = [F[None] for F in parallel_frames(kind)]
    pose, q, _, clear = parallel_candidates(frames, np.eye(4)[None], (0, 0, kind), (True,) * 6)
    assert not len(pose) and q.shape == (0, 6) and clear.all()
    assert seen[0] == pytest.approx(np.array([[max(1e-3, 40.0 * off**0.5)]]))
