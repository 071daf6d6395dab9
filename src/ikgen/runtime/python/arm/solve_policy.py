"""Tolerances and counts of `solve`."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["Policy"]


@dataclass(frozen=True)
class Policy:
    """Errors are in rad, or m over the arm's size."""

    arrived: float  # error below which a refined row is a solution
    exact: float  # and does not give way to better ones
    pose_tolerance: float  # how far a rotation's entries may be off
    orthonormal: float  # and what is round-off of them
    level: float  # by how much a heading's squared length may be short of 1
    coincident: float  # rows closer than that (rad or m) are one
    alike: float  # and singular ones, where the pose is theirs between them too:
    halfway: float  # to this error
    crowd: int  # rows of a continuum that are alike, at most
    limit_tolerance: float  # how far outside a limit a row is put back on it
    limit_reach: float  # and how far outside that is tried
    tries: int  # values tried for a joint that a pose leaves free
    try_step: float  # rad from one to the next
    rank_loss: float  # smallest singular value below which a refined row is singular
    continuum_rank_loss: float  # the same where the closed form says that it is
    fold_reach: float  # smallest singular value below which another row may be near
    beside_reach: float  # and below which poses beside are solved as well
    anywhere: float  # the same where they always are
    broken_reach: float  # below which a row may lie on a continuum that rounding broke
    farthest_start: float  # first step (rad, m) of rows that are refined together
    contraction: float  # of each further one
    pivot_share: float  # of the pivot: the first step at most, unless
    fold_product: float  # the two smallest singular values have a larger product
    least_pivot: float  # how far the derivatives by each joint must be from the others' span
    least_miss: float  # error that shows that a row ends beside the pose
    lane_steps: int  # at most
    least_damping: float
    damping: float  # of a Newton step, times the squared error
    largest_step: float  # of a joint
    converged: float  # error at which steps end
    patience: int  # steps without progress after which they end
    progress: float  # of a step: the factor by which the error falls
    refinement: tuple[tuple[int, float, float], ...]  # steps; errors between which more follow

    @property
    def beside_anywhere(self) -> bool:
        """Whether poses beside are always solved as well."""
        return self.beside_reach >= self.anywhere
