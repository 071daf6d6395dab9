"""Approximate solutions of five revolute joints and a slide: elimination of Raghavan and Roth (1993).

The loop is begun so that the slide is the first joint or the second. Of the fourteen functions of the other
side its monomials 1, d, d^2 are eliminated as cosine and sine would be; six equations are left in three
angles, the same as those of six revolute joints.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from ikgen.runtime.python.arrays.array_types import Array
from ikgen.runtime.python.arrays.rigid_motion import inverses, motions_z, rotations_z
from ikgen.runtime.python.elimination.back_substitution import (
    middle_angles,
    turned,
    with_last_angle,
)
from ikgen.runtime.python.elimination.both_half_angles import both_angles
from ikgen.runtime.python.elimination.general_6r import Candidates, Elimination
from ikgen.runtime.python.elimination.loop_equations import (
    FIT,
    ROTATIONS,
    invariants,
    joint_values,
    left_invariants,
    loop_action,
    loop_constants,
    of_constants,
)
from ikgen.runtime.python.rows.solution_rows import Turning, rows_of

__all__ = ["one_slide_both_candidates", "one_slide_candidates"]

Middle = Callable[[Array, Array, int], Candidates]

_SLIDE_SAMPLES = np.array([0.0, 1.0, -1.0])
_SAMPLED_SLIDES = motions_z(_SLIDE_SAMPLES)
_PARABOLA = np.array(
    [[1.0, 0.0, 0.0], [0.0, 0.5, -0.5], [-1.0, 0.5, 0.5]]
)  # of values at the samples


def one_slide_candidates(
    F: Sequence[Array], T: Array, elimination: Elimination, turning: Turning
) -> Candidates:
    """Approximate solutions of a chain whose joint that is not `turning` comes first or second. The result
    is that of `candidates`."""
    return _candidates(F, T, elimination, turning, middle_angles)


def one_slide_both_candidates(
    F: Sequence[Array], T: Array, elimination: Elimination, turning: Turning
) -> Candidates:
    """Candidates by half angles of both angles beside the hidden one."""
    return _candidates(F, T, elimination, turning, both_angles)


def _candidates(
    F: Sequence[Array], T: Array, elimination: Elimination, turning: Turning, angles_of: Middle
) -> Candidates:
    start, reverse, swap = elimination
    order, C = loop_constants(F, T, start, reverse)
    first = not turning[order[0]]
    left = of_constants(left_invariants, *C[2:5])
    right = _slide_side(C, first)
    basis = np.linalg.qr(right[..., 1:], mode="complete")[0][..., 8:]
    top = np.swapaxes(basis, 1, 2)
    E = top @ of_constants(loop_action, C[1])
    E[..., 14] -= (top @ right[..., :1])[..., 0]
    pose, t, least, clear = angles_of(E, left, swap)
    if not len(pose):
        return pose, np.zeros((0, 6)), least, clear
    found = _with_slide(
        [rows_of(c, pose) for c in C], rows_of(left, pose), rows_of(right, pose), t, first
    )
    return pose, joint_values(found, order, reverse), least, clear


def _slide_side(C: list[Array], first: bool) -> Array:
    """The invariants of `M_2^-1 C_1^-1 M_1^-1 C_6^-1` (N, 14, 9) in the monomials of the first joint times
    those of the second, a slide being the `first` of them or the other."""
    turn = np.swapaxes(ROTATIONS, 1, 2)
    one, two = (_SAMPLED_SLIDES, turn) if first else (turn, _SAMPLED_SLIDES)
    Y = inverses(C[0])[:, None] @ one @ inverses(C[5])[:, None]
    V = invariants(two @ Y[:, :, None])
    fits = (_PARABOLA, FIT) if first else (FIT, _PARABOLA)
    return np.swapaxes(np.kron(*fits) @ V.reshape(len(V), 9, 14), 1, 2)


def _with_slide(C: list[Array], left: Array, right: Array, t: Array, first: bool) -> Array:
    """The six values of the loop (k, 6) from theta_3, theta_4, theta_5 in t (k, 3): the slide and the angle
    beside it linearly, theta_6 from the rotation left over."""
    v = turned(left, t)
    u = (loop_action(C[1]) @ v[..., None])[..., 0]
    m = (np.linalg.pinv(right[..., 1:]) @ (u - right[..., 0])[..., None])[..., 0]
    cosine, sine, slide = (m[:, 0], m[:, 1], m[:, 2]) if first else (m[:, 2], m[:, 5], m[:, 0])
    angle = np.arctan2(sine, cosine)
    pair = (-slide, angle) if first else (angle, -slide)
    values = np.concatenate([np.stack(pair, axis=-1), t], axis=1)
    X = C[5]
    for i in range(5):
        moves = motions_z if i == (0 if first else 1) else rotations_z
        X = X @ moves(values[:, i]) @ C[i]
    return with_last_angle(values, X)
