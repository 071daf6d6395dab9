"""Values that what is held takes where none are given."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Iterator

from ikgen.errors import ArgumentError
from ikgen.kinematics.axis_relations import reach
from ikgen.kinematics.idle_joints import hardly_moves
from ikgen.model.chain import REVOLUTE, ActuatedJoint
from ikgen.model.dh import DHChain
from ikgen.model.joint_value import range_text, value_text

__all__ = ["VALUE_INSIDE", "free_defaults"]

VALUE_INSIDE = "give a value inside them: in rad or m, or with its unit, as 45deg or 120mm"
"""The hint where a value is outside limits."""

_SAMPLES = 32
_LOST = 1e-3
"""Share of what the smallest singular value is elsewhere below which a held value has taken a direction."""


def free_defaults(dh: DHChain, given: Iterable[tuple[str, float | None]]) -> tuple[float, ...]:
    """Default values (rad or m) of what is held, in that order: those `given` by name, else 0
    brought inside the limits, or another where what moves is singular everywhere with that. Raises
    UsageError for a given value outside them."""
    values = dict(given)
    length = reach(dh)
    choices = [_choices(held, values.get(held.name), length) for held in dh.held_inputs]
    first = tuple(one[0] for one in choices)
    if dh.arm_angle or dh.symbols or all(len(one) == 1 for one in choices):
        return first
    return next(_leaving_all(dh, itertools.product(*choices)), first)


def _choices(joint: ActuatedJoint, value: float | None, length: float) -> tuple[float, ...]:
    """The value that is given; of a joint that hardly moves, in an arm of a `length` (m), the middle; else,
    in the order in which they are tried, 0, the middle of limits that it is outside of or where they have
    none the limit next to it, and values between the limits."""
    low, high = joint.limits.lower, joint.limits.upper
    if value is not None:
        if low <= value <= high:
            return (value,)
        raise ArgumentError(
            f"--free {joint.name}={value_text(value)}: outside its limits, "
            f"{range_text(low, high, joint.kind == REVOLUTE)}",
            hint=f"{VALUE_INSIDE}; or none",
        )
    if hardly_moves(joint, length):
        return (0.5 * (low + high),)
    near = min(max(low, 0.0), high)
    bottom = low if math.isfinite(low) else min(high, math.pi) - 2.0 * math.pi
    top = high if math.isfinite(high) else bottom + 2.0 * math.pi
    others = tuple(bottom + share * (top - bottom) for share in (0.5, 0.75, 0.25))
    return others if near != 0.0 and math.isfinite(high - low) else (near, *others)


def _leaving_all(dh: DHChain, values: Iterable[tuple[float, ...]]) -> Iterator[tuple[float, ...]]:
    """The held values among these with which what moves has, at one of the samples at least, all directions
    that it has for others."""
    import numpy as np

    from ikgen.kinematics.forward import file_jacobian

    moving = [j for j in range(dh.dof) if j not in dh.free_indices]
    q = np.random.default_rng(0).uniform(-1.5, 1.5, (_SAMPLES, dh.dof))
    usual = np.linalg.svd(file_jacobian(dh, q)[..., moving], compute_uv=False)
    last = int((usual.max(axis=0) > _LOST * usual.max()).sum()) - 1
    least = _LOST * float(usual[:, last].max())
    for held in values:
        q[:, list(dh.free_indices)] = held
        found = np.linalg.svd(file_jacobian(dh, q)[..., moving], compute_uv=False)
        if found[:, last].max() >= least:
            yield held
