"""Probe configurations: random ones, and regular ones with joints at multiples of 90 degrees, slides at 0.

A constant that a file rounds and that is kept so has any value at the random ones: what is zero there
is so for every arm of the structure, not for cos(1.5708) being small. At the others it has the value
that was meant, so that a divisor which only rounding keeps from zero is seen to vanish.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from ikgen.kinematics.fixed_order import product
from ikgen.kinematics.forward import file_slopes
from ikgen.kinematics.rigid import dh_link, read_only
from ikgen.kinematics.whole_turns import range_of
from ikgen.model.dh import Angle, DHChain, DHRow, Length

__all__ = [
    "Probes", "arm_size", "dh_pose", "elbow_position", "in_ranges",
    "least_regular", "make_probes", "quarters", "smallest_singular",
]  # fmt: skip

Kept = Mapping[str, NDArray[np.float64]]
_NONE: Kept = MappingProxyType({})

GENERIC = 12
SPECIAL = 36
SINGULAR = 16


@dataclass(frozen=True, slots=True)
class Probes:
    """`values` (N, dof) DH variables (of each joint's leading row), `pose` (N, 4, 4) of the last DH frame
    in frame 0. The first `generic` are random, up to `regular` they have joints at multiples of 90
    degrees but are regular, the rest are singular. `typical` is the median of the smallest singular value
    at the random ones. `kept` are the values (N,) of rounded constants."""

    values: NDArray[np.float64]
    pose: NDArray[np.float64]
    generic: int
    regular: int
    typical: float
    kept: Kept = field(default_factory=lambda: _NONE)


def least_regular(usual: float, typical: float) -> float:
    """Smallest singular value above which a configuration is regular: the `usual` one, or half of what is
    `typical` of an arm that is nowhere far from singular."""
    return min(usual, max(0.5 * typical, 1e-6))


def _constant(x: Angle | Length, kept: Kept) -> float | NDArray[np.float64]:
    """The constant's signed value: the one at each probe, or the one that was meant."""
    if x.name is None or x.name not in kept:
        return x.nominal
    return x.sign * kept[x.name] if isinstance(x, Length) else kept[x.name]


def dh_pose(
    dh: DHChain, values: NDArray[np.float64], kept: Kept = _NONE, rows: int | None = None
) -> NDArray[np.float64]:
    """`A_1 ... A_n` (N, 4, 4) at DH variables `values` (N, dof), by default of all rows; rounded constants
    have the values `kept` (N,) by name, else those that were meant."""
    count = len(values)
    T = np.broadcast_to(np.eye(4), (count, 4, 4))
    for row in dh.rows[:rows]:
        ratio, shift = dh.follows(row)
        v = ratio * values[:, row.driver] + shift
        theta = v if row.revolute else np.full(count, row.theta.value)
        d = np.zeros(count) + _constant(row.d, kept) if row.revolute else v
        T = product(T, dh_link(_constant(row.alpha, kept), _constant(row.a, kept), theta, d))
    return T


def elbow_position(
    dh: DHChain, values: NDArray[np.float64], kept: Kept = _NONE
) -> NDArray[np.float64]:
    """The point (N, 3) in frame 0 at which the fourth axis of seven is nearest to the third."""
    link = dh_link(_constant(dh.rows[3].alpha, kept), _constant(dh.rows[3].a, kept), 0.0, 0.0)
    return np.asarray(product(dh_pose(dh, values, kept, rows=3), link)[:, :3, 3])


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
    leads = [dh.lead_row(j) for j in range(dh.dof)]
    scale, offset = (
        np.array(x) for x in zip(*((r.scale, r.offset.value) for r in leads), strict=True)
    )
    q = (values - offset) / scale
    slopes = file_slopes(_meant(dh, dh.rows, dh.X_tip if tool else np.eye(4)), q)
    slopes *= _read(readable)[..., None]
    slopes[:, :, 3] /= size
    entries = slopes.reshape(len(q), 12, dh.dof)
    if dh.arm_angle:
        link = dh_link(dh.rows[3].alpha.nominal, dh.rows[3].a.nominal, 0.0, 0.0)
        elbow = file_slopes(_meant(dh, dh.rows[:3], link), q)[:, :, 3] / size
        entries = np.concatenate([entries, elbow], axis=1)
    unit = np.array([1.0 if lead.revolute else size for lead in leads]) / scale
    moving = [j for j, joint in enumerate(dh.joints) if joint.name not in dh.free]
    return np.asarray(np.linalg.svd((entries * unit)[..., moving], compute_uv=False)[:, -1])


def _meant(dh: DHChain, rows: tuple[DHRow, ...], end: NDArray[np.float64]) -> DHChain:
    """The chain of some rows, from frame 0, with the constants that were meant in place of the file's."""
    links = [
        dh_link(row.alpha.nominal, row.a.nominal, 0.0, row.d.nominal)
        if row.revolute
        else dh_link(row.alpha.nominal, row.a.nominal, row.theta.value, 0.0)
        for row in rows
    ]
    return replace(dh, rows=rows, file_frames=(*links, end))


def _read(readable: Collection[str] | None) -> NDArray[np.float64]:
    """1 where an entry (3, 4) of the pose is read, else 0."""
    names = [[*(f"r{i}{j}" for j in (1, 2, 3)), f"p{axis}"] for i, axis in enumerate("xyz", 1)]
    return np.array(
        [[readable is None or name in readable for name in row] for row in names], float
    )


def arm_size(dh: DHChain) -> float:
    """A length typical of the arm in m."""
    lengths = [abs(x.nominal) for row in dh.rows for x in (row.a, row.d)]
    return max([*lengths, 1e-3]) if any(lengths) else 1.0


def make_probes(
    dh: DHChain,
    *,
    tool: bool = False,
    readable: Collection[str] | None = None,
) -> Probes:
    """Probe configurations of a chain, the same for the same chain.

    With `tool` the poses include the tool transform. What is regular is so for a task that reads the
    entries `readable` of the pose, by default all.
    """
    rng = np.random.default_rng(0)
    size = arm_size(dh)
    revolute = np.array([dh.lead_row(j).revolute for j in range(dh.dof)])

    def random(count: int) -> NDArray[np.float64]:
        angles = in_ranges(dh, rng.uniform(-np.pi, np.pi, (count, dh.dof)))
        lengths = size * rng.uniform(0.3, 1.5, (count, dh.dof))
        return np.where(revolute, angles, lengths)

    generic = random(GENERIC)
    special = random(8 * SPECIAL)
    quarter = quarters(dh, rng.integers(-1, 3, special.shape))
    chosen = rng.random(special.shape) < rng.uniform(0.15, 1.0, (len(special), 1))
    special = np.where(chosen, np.where(revolute, quarter, 0.0), special)
    smallest, generally = (
        smallest_singular(dh, q, size, readable=readable, tool=tool) for q in (special, generic)
    )
    typical = float(np.median(generally))
    regular = special[smallest > least_regular(1e-2, typical)][:SPECIAL]
    singular = special[smallest < 1e-8][:SINGULAR]
    values = np.concatenate([generic, regular, singular])
    kept = _kept_values(dh, len(values), size)
    pose = dh_pose(dh, values, kept)
    if tool:
        pose = product(pose, dh.X_tip)
    values, pose = read_only(values), read_only(pose)
    return Probes(values, pose, GENERIC, GENERIC + len(regular), typical, kept)


def in_ranges(dh: DHChain, turns: NDArray[np.float64]) -> NDArray[np.float64]:
    """Angles (N, dof) of a whole circle, those of each joint brought where its own are looked for."""
    turns = turns.copy()
    for joint, row in enumerate(map(dh.lead_row, range(dh.dof))):
        low, high = range_of(dh, joint) if row.revolute else (-np.pi, np.pi)
        if high - low < 2.0 * np.pi:
            turns[:, joint] = 0.5 * (low + high) + (high - low) / (2.0 * np.pi) * turns[:, joint]
    return turns


def quarters(dh: DHChain, counts: NDArray[np.int64]) -> NDArray[np.float64]:
    """DH variables (N, dof) at these numbers of quarter turns: of the variable, or where several turns of
    the joint are on the circle of the joint."""
    values = counts * (np.pi / 2)
    for joint, row in enumerate(map(dh.lead_row, range(dh.dof))):
        if row.revolute and range_of(dh, joint) != (-np.pi, np.pi):
            values[:, joint] = row.scale * values[:, joint] + row.offset.value
    return np.asarray(values)


def _kept_values(dh: DHChain, count: int, size: float) -> Kept:
    """Values (count,) of the rounded constants: random ones at the generic probes."""
    rng = np.random.default_rng(len(dh.rows))
    kept: dict[str, NDArray[np.float64]] = {}
    for row in dh.rows:
        for x in (row.alpha, row.a, row.d):
            if x.name is None or x.name in kept or not x.rounded:
                continue
            kept[x.name] = np.full(count, x.nominal)
            off = rng.uniform(0.15, 0.45, GENERIC) * rng.choice((-1.0, 1.0), GENERIC)
            if count > GENERIC:  # else nothing would show the value that was meant
                kept[x.name][:GENERIC] += off if isinstance(x, Angle) else size * off
    return MappingProxyType(kept)
