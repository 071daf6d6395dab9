"""Measures of the links about two parallel axes, against where the common normals lie."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.chains import rotation, translation

from ikgen.runtime.python.elimination.parallel_links import (
    MEETING,
    PLAIN,
    UPRIGHT,
    ParallelLinks,
    deviation,
    links_of,
    parallel_links,
)

Array = NDArray[np.float64]


def feet(p: Array, z: Array, q: Array, y: Array) -> tuple[float, float]:
    """How far along z from p, and along y from q, the lines come nearest to each other."""
    A = np.stack([z, -y], axis=1)
    along, other = np.linalg.lstsq(A, q - p, rcond=None)[0]
    return float(along), float(other)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_measures_are_those_of_axes_and_common_normals(side: float) -> None:
    rng = np.random.default_rng(5)
    flip = np.eye(4) if side > 0.0 else rotation([1.0, 0.0, 0.0], np.pi)
    for _ in range(8):
        first, third = (
            translation(*rng.normal(size=3)) @ rotation(rng.normal(size=3), 1.3) for _ in range(2)
        )
        second = translation(*rng.normal(size=3)) @ rotation([0.0, 0.0, 1.0], 0.7) @ flip
        frames = [np.eye(4), first, first @ second, first @ second @ third]
        (z1, n, z3, z4), (p1, p2, p3, p4) = ([F[:3, column] for F in frames] for column in (2, 3))
        of = links_of(parallel_links([C[None] for C in (first, second, third)]))
        h1, low = feet(p1, z1, p2, n)
        high, h4 = feet(p3, n, p4, z4)
        high += float((p3 - p2) @ n)
        found = [float(x[0, 0]) for x in of]
        names = ParallelLinks._fields
        value = dict(zip(names, found, strict=True))
        assert value["h1"] == pytest.approx(h1) and value["h4"] == pytest.approx(h4)
        assert value["d"] == pytest.approx(high - low)
        assert value["side"] == side and z3 @ n == pytest.approx(side)
        assert value["c1"] == pytest.approx(z1 @ n) and value["c3"] == pytest.approx(z4 @ n)
        assert value["a2"] == pytest.approx(np.linalg.norm(np.cross(p3 - p2, n)))
        for name, way, normal in (
            ("a1", p2 - p1, np.cross(z1, n)), ("a3", p4 - p3, np.cross(n, z4)),
        ):  # fmt: skip
            assert value[name] == pytest.approx(way @ normal / np.linalg.norm(normal))
        assert value["tilt"] == pytest.approx(0.0, abs=1e-15)


def test_a_kind_takes_its_measures_for_nothing() -> None:
    numbers = np.array([0.1, -0.02, 0.003, 7.0, -0.0004, -0.00005, 5.0, 6.0, 1.0, 0.000006])
    of = links_of(numbers[None])
    for kind, wanted in ((UPRIGHT, 0.120056), (MEETING, 0.003406), (PLAIN, 0.123456)):
        assert deviation(kind, of) == pytest.approx(np.array([[wanted]]))
