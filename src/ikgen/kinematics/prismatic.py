"""Where to put the line of a prismatic joint, of which only the direction matters.

Moving the line of prismatic axis k by c changes link k - 1 by +c and link k by -c and nothing else,
since translations commute. Each line is tried through a few points that make lengths vanish and
stays where the fewest are left.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ikgen.kinematics.fixed_order import dot, product
from ikgen.kinematics.links import Link, Tolerance, orient
from ikgen.kinematics.offsets import distribute
from ikgen.model.arrays import Array

__all__ = ["place_prismatic"]

_Placement = tuple[tuple[Link, ...], tuple[Array, ...]]

_WIDTH = 12
"""Placements kept at each step of the search; lines of neighbours depend on each other."""

_ACROSS = np.array([1.0, 1.0, 0.0])


def place_prismatic(
    links: tuple[Link, ...], prismatic: tuple[bool, ...], tolerance: Tolerance
) -> tuple[tuple[Link, ...], tuple[Array, ...]]:
    """The links with prismatic lines moved, and each axis' shift (3,) in m in its own frame."""
    still = tuple(np.zeros(3) for _ in prismatic)
    sliding = [k for k, slides in enumerate(prismatic) if slides]
    if not links or not sliding:
        return links, still
    order = sliding if len(sliding) == 1 else [*sliding, *reversed(sliding), *sliding]
    kept = [(links, still)]
    for k in order:
        tried = [
            (_shifted(links, k, c), (*shifts[:k], shifts[k] + c, *shifts[k + 1 :]))
            for links, shifts in kept
            for c in _candidates(links, k)
        ]
        tried.sort(key=lambda placed: _cost(placed[0], prismatic, tolerance))
        kept = _distinct(tried)[:_WIDTH]
    return kept[0]


def _distinct(placements: list[_Placement]) -> list[_Placement]:
    """`placements` without those whose shifts (m) repeat an earlier one's."""
    seen: dict[tuple[float, ...], _Placement] = {}
    for links, shifts in placements:
        key = tuple(round(float(v), 9) for v in np.concatenate(shifts))
        seen.setdefault(key, (links, shifts))
    return list(seen.values())


def _cost(
    links: tuple[Link, ...], prismatic: tuple[bool, ...], tolerance: Tolerance
) -> tuple[int, int, int]:
    shapes, _ = orient(links, False, tolerance)
    offsets = distribute(shapes, prismatic)
    lengths = sum(shape.a != 0.0 for shape in shapes)
    shifts = turns = 0
    for k, slides in enumerate(prismatic):
        nonzero = abs(offsets.d[k]) > tolerance.length + offsets.length_error[k]
        lengths += nonzero and not slides
        shifts += nonzero and slides
        turns += slides and 0 < k < len(prismatic) - 1 and abs(offsets.theta[k]) > tolerance.angle
    return lengths, shifts, turns


def _shifted(links: tuple[Link, ...], k: int, c: Array) -> tuple[Link, ...]:
    """`links` with the line of axis k moved by c (3,), given in the frame of axis k."""
    moved = list(links)
    around = [link.length_error for link in links[max(0, k - 1) : k + 1]]
    length_error = max(around)
    if k > 0:
        link = links[k - 1]
        moved[k - 1] = replace(link, p=link.p + product(link.R, c), length_error=length_error)
    if k < len(links):
        link = links[k]
        moved[k] = replace(link, p=link.p - c, length_error=length_error)
    return tuple(moved)


def _candidates(links: tuple[Link, ...], k: int) -> Iterator[Array]:
    """Shifts of axis k in its frame: through the next or previous origin, both axes, or none."""
    frames = [(np.eye(3), np.zeros(3))]
    for link in links:
        R, o = frames[-1]
        frames.append((product(R, link.R), o + product(R, link.p)))
    R, o = frames[k]
    if k + 1 < len(frames):
        yield _ACROSS * product(R.T, _origin(frames, k + 1, +1) - o)
    if k > 0:
        yield _ACROSS * product(R.T, _origin(frames, k - 1, -1) - o)
    if 0 < k < len(links):
        (R_prev, o_prev), (R_next, o_next) = frames[k - 1], frames[k + 1]
        columns = np.column_stack([R_prev[:, 2], R[:, 2], -R_next[:, 2]])
        along = np.linalg.lstsq(columns, o_next - o_prev, rcond=1e-9)[0]
        yield _ACROSS * product(R.T, o_prev + along[0] * R_prev[:, 2] - o)
    yield np.zeros(3)


def _origin(frames: list[tuple[Array, Array]], k: int, step: int) -> Array:
    """Point of axis k level with the common normal at the `step` end of its run of parallels."""
    z, o = frames[k][0][:, 2], frames[k][1]
    j = k
    while 0 <= j + step < len(frames):
        z_next, o_next = frames[j + step][0][:, 2], frames[j + step][1]
        normal = np.cross(z, z_next)
        square = dot(normal, normal)
        if square > 1e-18:
            along = dot(np.cross(o_next - frames[j][1], z_next), normal) / square
            foot = frames[j][1] + z * along
            return np.asarray(o + z * dot(z, foot - o))
        j += step
    return o
