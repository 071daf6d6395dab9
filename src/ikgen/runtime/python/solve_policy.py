"""Tolerances and counts of `solve`."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["Policy"]


@dataclass(frozen=True)
class Policy:
    """Errors are in rad, or m over the arm's size.

    `arrived`: error below which refined rows are solutions. `pose_tolerance`: how far a rotation's
    entries may be off, `orthonormal`: what is round-off of them. `coincident`: rows closer than that
    (rad or m) are one. `limit_tolerance`: how far outside a limit a row is put back on it. `tries`:
    values tried for a joint that a pose leaves free, `try_step` rad apart. `rank_loss`: smallest
    singular value below which a refined row is singular, `continuum_rank_loss` where the closed form
    says so. A Newton step is damped by max(`least_damping`, `damping` * error^2), and at most
    `largest_step` a joint; steps end at `converged`, or when `patience` of them pass without the error
    falling to `progress` of what it was. `refinement`: steps, and the errors between which they go on.
    """

    arrived: float
    pose_tolerance: float
    orthonormal: float
    coincident: float
    limit_tolerance: float
    tries: int
    try_step: float
    rank_loss: float
    continuum_rank_loss: float
    least_damping: float
    damping: float
    largest_step: float
    converged: float
    patience: int
    progress: float
    refinement: tuple[tuple[int, float, float], ...]
