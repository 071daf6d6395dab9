"""The arguments `free` and `seed` as joint values."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import isfinite

import numpy as np
from numpy.typing import ArrayLike

from ikgen.runtime.python.arm.held_parameters import held_of
from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arrays.array_types import Array, Row
from ikgen.runtime.python.arrays.real_numbers import real_array

__all__ = ["held_rows", "held_values", "seed_rows", "seed_values"]

_FARTHEST = 1e6  # rad: neighbouring doubles are 1e-10 apart


def held_values(
    arm: Arm, free: Sequence[float] | Mapping[str, float] | None, near: Row | None
) -> Row:
    """Values of the held joints, base to tip: those of the seed `near`, or without one the defaults,
    where `free` gives none. Raises ValueError where they are no such values."""
    names, others = arm.free_joints, arm.free_defaults
    if near is not None:
        others = tuple(held_of(arm, np.array(near)).tolist())
    if free is None:
        return others
    if isinstance(free, Mapping):
        unknown = set(free) - set(names)
        if unknown:
            raise ValueError(f"no free joint named {sorted(unknown)}; there is {list(names)}")
        given = real_array([free.get(n, x) for n, x in zip(names, others)], "free")
        values = tuple(given.reshape(-1).tolist())
    else:
        given = real_array(free, "free")
        if given.ndim > 1:
            raise ValueError(f"free has shape {given.shape}, expected ({len(names)},)")
        values = tuple(given.reshape(-1).tolist())
    if len(values) != len(names):
        many = "value" if len(values) == 1 else "values"
        raise ValueError(f"free has {len(values)} {many}, expected {len(names)}")
    if not all(map(isfinite, values)):
        raise ValueError(f"free {list(values)} has values that are not finite")
    return values


def held_rows(
    arm: Arm, free: ArrayLike | Mapping[str, float] | None, near: Array | None, count: int
) -> Array:
    """`held_values` for many poses: one row for all of them, or one each (of one joint: one value each);
    (count, held joints). `near`: the seeds (count, dof)."""
    shape = (count, len(arm.free_joints))
    if free is None or isinstance(free, Mapping):
        values = np.tile(held_values(arm, free, None), (count, 1)).reshape(shape)
        given = () if free is None else free
        if near is not None:
            own = [k for k, name in enumerate(arm.free_joints) if name not in given]
            values[:, own] = held_of(arm, near)[:, own]
        return values
    held = real_array(free, "free")
    single = len(arm.free_joints) == 1 and held.shape == (count,)
    if held.ndim < 2 and not single:
        one: list[float] = held.tolist()
        return np.broadcast_to(held_values(arm, one, None), shape)
    held = held[:, None] if single else held
    if held.shape != shape:
        raise ValueError(f"free has shape {held.shape}, expected {shape}")
    if not np.isfinite(held).all():
        raise ValueError("free has values that are not finite")
    return held


def seed_values(arm: Arm, seed: ArrayLike | None) -> Row | None:
    """`seed_rows` of one seed, if there is one."""
    return None if seed is None else tuple(seed_rows(arm, seed, (len(arm.lower),)).tolist())


def seed_rows(arm: Arm, seed: ArrayLike, *shapes: tuple[int, ...], name: str = "seed") -> Array:
    """The seed, called `name`, as an array of one of the shapes; raises ValueError for others. Turns of a
    revolute joint that doubles cannot tell apart to 1e-10 rad are left out."""
    values = real_array(seed, name)
    if values.shape not in shapes:
        expected = " or ".join(map(str, shapes))
        raise ValueError(f"{name} has shape {values.shape}, expected {expected}")
    if not np.isfinite(values).all():
        place = np.argwhere(~np.isfinite(values))[0].tolist()
        raise ValueError(f"{name}{place} is {values[tuple(place)]}, which is not finite")
    period = np.array(arm.placing)
    far = (np.abs(values) > _FARTHEST) & (period > 0.0)
    turn = np.where(far, period, 1.0)
    return np.where(far, np.fmod(values, turn), values) if far.any() else values
