"""Axes of one joint behind each other are one where their motion is: linkages, telescopes, split wrists."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from ikgen.chains.merged_axes import merged_axes
from ikgen.kinematics.rigid import axis_motion, rotation_rpy
from ikgen.model.chain import PRISMATIC, REVOLUTE, ChainAxis

Array = NDArray[np.float64]

X, Y, Z = np.eye(3)
SPANS = (3.0,) * 4
TIP = np.eye(4)
TIP[:3, 3] = 0.1, 0.2, 0.3


def axis(
    xyz: tuple[float, float, float] = (0.0, 0.0, 0.0),
    *,
    rpy: tuple[float, float, float] = (0.0, 0.0, 0.0),
    about: Array = Z,
    times: float = 1.0,
    plus: float = 0.0,
    kind: str = REVOLUTE,
    driver: int = 0,
) -> ChainAxis:
    T = np.eye(4)
    T[:3, 3], T[:3, :3] = xyz, rotation_rpy(*rpy)
    return ChainAxis("axis", kind, T, about, driver, times, plus)


def forward(axes: tuple[ChainAxis, ...], T_last_tip: Array, q: Array) -> Array:
    T = np.eye(4)
    for one in axes:
        value = one.multiplier * q[one.driver] + one.offset
        T = T @ one.T_prev_axis @ axis_motion(one.kind == REVOLUTE, one.axis, value)
    return T @ T_last_tip


PARALLELOGRAM = (
    axis((0.0, 0.03, 0.15), rpy=(-1.57, -1.57, 0.0)),
    axis((0.04, 0.15, -0.01), times=-1.0, plus=0.2),
    axis((-0.52, 0.0, -0.02), rpy=(0.0, 0.0, 0.7), plus=-0.1),
)
ONE = {
    "the parallelogram of a remote centre": PARALLELOGRAM,
    "one whose axes point against each other": (
        axis((0.0, 0.0, 0.4)),
        axis((0.3, 0.1, 0.2), rpy=(math.pi, 0.0, 0.4), times=1.0),
        axis((0.2, 0.0, 0.0), rpy=(0.0, 0.0, 0.3), times=-1.0),
    ),
    "a joint in two halves": (axis(times=0.5), axis((0.0, 0.0, 0.3), times=1.5)),
    "stages of a telescope": tuple(
        axis((0.0, 0.0, 0.01), about=Z, kind=PRISMATIC, plus=0.1) for _ in range(4)
    ),
    "slides of two directions": (
        axis((0.1, 0.0, 0.0), about=X, kind=PRISMATIC),
        axis((0.0, 0.3, 0.0), rpy=(0.4, 0.5, 0.6), about=Y, kind=PRISMATIC, times=-0.5, plus=0.2),
    ),
}
SEVERAL = {
    "a parallelogram that keeps a direction": (axis(), axis((0.5, 0.0, 0.0), times=-1.0)),
    "an elbow that turns as far as the shoulder": (axis(), axis((0.5, 0.0, 0.0))),
    "axes that are not parallel": (axis(), axis(rpy=(1.0, 0.0, 0.0))),
    "slides that take each other back": (axis(kind=PRISMATIC), axis(kind=PRISMATIC, times=-1.0)),
    "a turn and a slide": (axis(), axis(kind=PRISMATIC)),
    "two joints": (axis(), axis(driver=1)),
}


@pytest.mark.parametrize("axes", ONE.values(), ids=ONE.keys())
def test_what_moves_as_one_axis_is_one(axes: tuple[ChainAxis, ...]) -> None:
    merged, tip = merged_axes(axes, TIP, SPANS)
    assert len(merged) == 1
    for q in np.random.default_rng(1).uniform(-3.0, 3.0, (20, 1)):
        assert np.allclose(forward(merged, tip, q), forward(axes, TIP, q), rtol=0.0, atol=1e-14)


@pytest.mark.parametrize("axes", SEVERAL.values(), ids=SEVERAL.keys())
def test_what_does_not_stays_as_it_is(axes: tuple[ChainAxis, ...]) -> None:
    merged, tip = merged_axes(axes, TIP, SPANS)
    assert [one.axis is other.axis for one, other in zip(merged, axes, strict=True)]
    assert np.array_equal(tip, TIP)
    assert all(
        np.array_equal(a.T_prev_axis, b.T_prev_axis) for a, b in zip(merged, axes, strict=True)
    )


@pytest.mark.parametrize(("span", "count"), [(3.1, 1), (3.2, 2)])
def test_turns_that_are_different_configurations_inside_the_limits_are_told_apart(
    span: float, count: int
) -> None:
    """The tip comes round every half turn of the joint, its first half every second whole one."""
    axes = ONE["a joint in two halves"]
    assert len(merged_axes(axes, TIP, (span,))[0]) == count
    assert len(merged_axes(PARALLELOGRAM, TIP, (math.inf,))[0]) == 1


def test_others_stand_before_and_behind() -> None:
    axes = (
        axis((0.1, 0.2, 0.3), rpy=(0.1, 0.2, 0.3), driver=0),
        *(axis((0.2, 0.0, 0.1), times=times, driver=1) for times in (1.0, -1.0, 1.0)),
        axis((0.2, 0.3, 0.1), rpy=(0.3, 0.2, 0.1), about=Y, driver=2),
        axis((0.0, 0.1, 0.0), rpy=(0.3, 0.2, 0.1), about=X, driver=3),
    )
    merged, tip = merged_axes(axes, TIP, SPANS)
    assert [one.driver for one in merged] == [0, 1, 2, 3]
    for q in np.random.default_rng(2).uniform(-3.0, 3.0, (20, 4)):
        assert np.allclose(forward(merged, tip, q), forward(axes, TIP, q), rtol=0.0, atol=1e-14)
