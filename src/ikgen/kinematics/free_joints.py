"""Values that what is held takes where none are given."""

from __future__ import annotations

import math
from collections.abc import Iterable

from ikgen.errors import UsageError
from ikgen.model.chain import ActuatedJoint
from ikgen.model.dh import DHChain

__all__ = ["free_defaults"]


def free_defaults(dh: DHChain, given: Iterable[tuple[str, float | None]]) -> tuple[float, ...]:
    """Default values (rad or m) of what is held, in that order: those `given` by name, else 0
    brought inside the limits. Raises UsageError for a given value outside them."""
    values = dict(given)
    return tuple(_default(held, values.get(held.name)) for held in dh.held_inputs)


def _default(joint: ActuatedJoint, value: float | None) -> float:
    """The middle of limits that 0 is outside of, where they have one; else the limit next to 0."""
    low, high = joint.limits.lower, joint.limits.upper
    if value is not None:
        if low <= value <= high:
            return value
        raise UsageError(
            f"--free {joint.name}={value:.9g}: outside its limits, {low:.9g} to {high:.9g}",
            hint="give a value inside them (rad or m), or none",
        )
    if low <= 0.0 <= high:
        return 0.0
    return 0.5 * (low + high) if math.isfinite(high - low) else max(low, min(high, 0.0))
