"""Probe configurations: random ones, and regular ones with joints at multiples of 90 degrees."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ikgen.model.dh import DHChain

__all__ = ["Probes", "arm_size", "dh_pose", "make_probes", "smallest_singular"]

GENERIC = 12
SPECIAL = 36
SINGULAR = 16


@dataclass(frozen=True, slots=True)
class Probes:
    """`values` (N, dof) DH variables (of each joint's first row), `pose` (N, 4, 4) of the last DH frame
    in frame 0. The first `generic` are random, up to `regular` they have joints at multiples of 90
    degrees but are regular, the rest are singular."""

    values: NDArray[np.float64]
    pose: NDArray[np.float64]
    generic: int
    regular: int


def _transform(
    alpha: float, a: float, theta: NDArray[np.float64], d: NDArray[np.float64]
) -> NDArray[np.float64]:
    ca, sa, ct, st = np.cos(alpha), np.sin(alpha), np.cos(theta), np.sin(theta)
    zero, one = np.zeros_like(ct), np.ones_like(ct)
    rows = [
        [ct, -st, zero, a * one],
        [st * ca, ct * ca, -sa * one, -sa * d],
        [st * sa, ct * sa, ca * one, ca * d],
        [zero, zero, zero, one],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def dh_pose(dh: DHChain, values: NDArray[np.float64]) -> NDArray[np.float64]:
    """`A_1 ... A_n` (N, 4, 4) at DH variables `values` (N, dof)."""
    count = len(values)
    T = np.broadcast_to(np.eye(4), (count, 4, 4))
    first: dict[int, int] = {}
    for i, row in enumerate(dh.rows):
        lead = dh.rows[first.setdefault(row.driver, i)]
        ratio = row.scale / lead.scale
        v = ratio * (values[:, row.driver] - lead.offset.value) + row.offset.value
        theta = v if row.revolute else np.full(count, row.theta.value)
        d = np.full(count, row.d.value) if row.revolute else v
        T = T @ _transform(row.alpha.value, row.a.value, theta, d)
    return T


def smallest_singular(
    dh: DHChain,
    values: NDArray[np.float64],
    size: float,
    *,
    readable: Collection[str] | None = None,
    tool: bool = False,
) -> NDArray[np.float64]:
    """Smallest singular value (N,) of the pose's derivative by the joints that are not held, at DH
    variables `values` (N, dof), lengths in units of the arm's size.

    `readable` names the entries of the pose that the task reads, by default all; with `tool` the pose
    is that of the tip.
    """
    h = 1e-6
    read = _read(readable)
    end = dh.X_tip if tool else np.eye(4)
    columns = []
    for j in range(dh.dof):
        if dh.joints[j].name in dh.free:
            continue
        step = np.zeros(dh.dof)
        step[j] = h * (1.0 if dh.rows[_first_row(dh, j)].revolute else size)
        dT = (dh_pose(dh, values + step) - dh_pose(dh, values - step)) @ end / (2 * h)
        dT = dT[:, :3, :] * read
        dT[:, :, 3] /= size
        columns.append(dT.reshape(len(values), 12))
    J = np.stack(columns, axis=-1)
    return np.asarray(np.linalg.svd(J, compute_uv=False)[:, -1])


def _read(readable: Collection[str] | None) -> NDArray[np.float64]:
    """1 where an entry (3, 4) of the pose is read, else 0."""
    names = [[*(f"r{i}{j}" for j in (1, 2, 3)), f"p{axis}"] for i, axis in enumerate("xyz", 1)]
    return np.array(
        [[readable is None or name in readable for name in row] for row in names], float
    )


def _first_row(dh: DHChain, joint: int) -> int:
    return next(i for i, row in enumerate(dh.rows) if row.driver == joint)


def arm_size(dh: DHChain) -> float:
    """A length typical of the arm in m."""
    lengths = [abs(x.value) for row in dh.rows for x in (row.a, row.d)]
    return max([*lengths, 1e-3]) if any(lengths) else 1.0


def make_probes(
    dh: DHChain,
    *,
    seed: int = 0,
    tool: bool = False,
    readable: Collection[str] | None = None,
) -> Probes:
    """Probe configurations of a chain, the same for the same chain.

    With `tool` the poses include the tool transform. What is regular is so for a task that reads the
    entries `readable` of the pose, by default all.
    """
    rng = np.random.default_rng(seed)
    size = arm_size(dh)
    revolute = np.array([dh.rows[_first_row(dh, j)].revolute for j in range(dh.dof)])

    def random(count: int) -> NDArray[np.float64]:
        angles = rng.uniform(-np.pi, np.pi, (count, dh.dof))
        lengths = size * rng.uniform(0.3, 1.5, (count, dh.dof))
        return np.where(revolute, angles, lengths)

    generic = random(GENERIC)
    special = random(8 * SPECIAL)
    quarter = rng.integers(-1, 3, special.shape) * (np.pi / 2)
    chosen = (rng.random(special.shape) < rng.uniform(0.15, 1.0, (len(special), 1))) & revolute
    special = np.where(chosen, quarter, special)
    smallest = smallest_singular(dh, special, size, readable=readable, tool=tool)
    regular = special[smallest > 1e-2][:SPECIAL]
    singular = special[smallest < 1e-8][:SINGULAR]
    values = np.concatenate([generic, regular, singular])
    pose = dh_pose(dh, values)
    if tool:
        pose = pose @ dh.X_tip
    return Probes(values, pose, GENERIC, GENERIC + len(regular))
