"""Tolerances and counts of `solve`."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["Policy"]


@dataclass(frozen=True)
class Policy:
    """Errors are in rad, or m over the arm's size."""

    arrived: float  # error below which a refined row is a solution
    exact: float  # error below which a solution gives way to no better one nearby
    pose_tolerance: float  # how far a rotation's entries may be off
    orthonormal: float  # how far a rotation's entries may be off by round-off
    level: float  # by how much a heading's squared length may be short of 1
    coincident: float  # rad or m: rows closer than that are one
    neighbouring: float  # rad or m: rows closer than that in every joint are neighbours
    halfway: float  # error up to which the pose is that of what is between two rows
    crowd: int  # neighbours on a continuum, at most
    limit_tolerance: float  # rad or m: a row no farther outside a limit is put back on it
    limit_reach: float  # rad or m: a row no farther outside a limit is tried on it
    tries: int  # values tried for a joint that a pose leaves free
    try_step: float  # rad from one value that is tried to the next
    singular_below: float  # smallest singular value below which a refined row is singular
    continuum_below: float  # smallest singular value below which one is that the closed form marks
    fold_reach: float  # smallest singular value below which another row may be near
    beside_reach: float  # smallest singular value below which poses beside are solved as well
    anywhere: float  # `beside_reach` from which on poses beside always are
    broken_reach: float  # smallest singular value below which rounding may have broken a continuum
    farthest_start: float  # rad or m: first step, at most, of rows that are refined together
    contraction: float  # most that a further step of theirs may be of the one before
    least_pivot: float  # least pivot: distance of a joint's derivatives from the span of others'
    pivot_share: float  # most that their first step may be of the pivot, up to `fold_product`
    fold_product: float  # product of the two smallest singular values above which it may be more
    least_miss: float  # error that shows that a row ends beside the pose
    lane_steps: int  # steps of rows that are refined together, at most
    least_damping: float  # damping of a Newton step, at least
    damping: float  # damping of a Newton step, over the squared error
    largest_step: float  # rad or m: a joint's Newton step, at most
    converged: float  # error at which Newton steps end
    patience: int  # steps without progress after which they end
    progress: float  # factor by which the error falls in a step that is progress
    refinement: tuple[tuple[int, float, float], ...]  # steps, and errors between which more follow

    @property
    def beside_anywhere(self) -> bool:
        """Whether poses beside are always solved as well."""
        return self.beside_reach >= self.anywhere
