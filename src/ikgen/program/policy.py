"""What every emitted `solve` does with the rows of a Program: the numbers that all languages share."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["LEVEL", "REFINEMENT", "RefineStage", "SolvePolicy"]


LEVEL = 1e-4
"""Most by which a heading's squared length falls short of 1, or changes, of a tool that stays as it is: by
tilts of some half turns that are written as 3.14, and of measured axes. Poses are read to as much."""


@dataclass(frozen=True, slots=True)
class RefineStage:
    """At most `steps` damped Newton steps; rows whose error (rad, m over the arm's size) is then at least
    `fine` and below `promising` go on to the next stage."""

    steps: int
    fine: float
    promising: float


REFINEMENT: tuple[RefineStage, ...] = (
    RefineStage(3, 1e-12, 0.1),
    RefineStage(6, 1e-12, 1e-3),
    RefineStage(30, 0.0, 0.0),
)
"""Only what is promising takes many steps; elsewhere all digits are wanted, as rows may lie on a limit."""


@dataclass(frozen=True, slots=True)
class SolvePolicy:
    """Tolerances and counts of `solve`, the same in every language but for `near`. Errors are in rad, or m
    over the arm's size; the deviation is how far the file is off what was solved.

    - `arrived`: error below which a refined row is a solution.
    - `exact`: error below which a solution gives way to no better one nearby.
    - `rough_square`: squared error above which a row is refined.
    - `pose_tolerance`: how far a rotation's entries may be off; a nearer one is replaced by the nearest
      rotation.
    - `orthonormal`: how far a rotation's entries may be off by round-off.
    - `level`: by how much a heading's squared length may be short of 1.
    - `coincident`: rows closer than that (rad or m) are one.
    - `neighbouring`: rows closer than that in every joint (rad or m) are neighbours. Singular ones are one,
      if the pose is theirs between them; of a continuum `crowd` stay, of a search on a grid the best.
    - `halfway`: error up to which the pose is that of what is between two rows.
    - `crowd`: neighbours on a continuum, at most: as many as solutions meet where two folds do.
    - `meeting`: how close branches are where their rows are compared.
    - `limit_tolerance`: a row no farther outside a limit (rad or m) is put back on it.
    - `limit_reach`: a row no farther outside a limit (rad or m) is tried on it, by Newton steps.
    - `tries`: values tried for a joint that a pose leaves free.
    - `try_step`: rad from one value that is tried to the next.
    - `singular_below`: smallest singular value below which a refined row is singular.
    - `continuum_below`: smallest singular value below which one is that the closed form marks.
    - `fold_reach`: smallest singular value below which another row may be near, nearer than the
      closed form tells.
    - `beside_reach`: smallest singular value below which poses beside are solved as well.
    - `fold`: both over the root of the deviation, where there is one.
    - `anywhere`: `beside_reach` from which on poses beside always are.
    - `broken_reach`: smallest singular value below which rounding may have broken a continuum, over the
      deviation: along it the error is as small as that, and so is its slope.
    - `farthest_start`: first step (rad or m), at most, of rows that are refined together; others are
      refined one by one.
    - `contraction`: most that a further step of theirs may be of the one before.
    - `least_pivot`: least pivot: distance of a joint's derivatives from the span of others'.
    - `pivot_share`: most that their first step may be of the pivot, up to `fold_product`.
    - `fold_product`: product of the two smallest singular values above which it may be more, over the
      deviation, as no other solution comes in there.
    - `least_miss`: error that shows that a row ends beside the pose.
    - `near`: the largest step behind which derivatives are not taken anew; of C++ alone.
    - `lane_steps`: steps of rows that are refined together, at most.
    - `least_damping`: damping of a Newton step, at least.
    - `damping`: damping of a Newton step, over the squared error.
    - `largest_step`: a joint's Newton step (rad or m), at most.
    - `converged`: error at which Newton steps end.
    - `patience`: steps without progress after which they end.
    - `progress`: factor by which the error falls in a step that is progress.
    - `refinement`: steps, and errors between which more follow, by stages.
    """

    arrived: float = 0.5e-9
    exact: float = 1e-12
    rough_square: float = 1e-24
    pose_tolerance: float = 1e-6
    orthonormal: float = 1e-14
    level: float = LEVEL
    coincident: float = 1e-6
    neighbouring: float = 1e-2
    halfway: float = 2e-14
    crowd: int = 4
    meeting: float = 2e-5
    limit_tolerance: float = 2e-10
    limit_reach: float = 1e-5
    tries: int = 16
    try_step: float = 0.39269908169872414
    singular_below: float = 1e-7
    continuum_below: float = 1e-3
    fold_reach: float = 1e-4
    beside_reach: float = 0.0
    fold: float = 0.3
    anywhere: float = 1e3
    broken_reach: float = 15.0
    farthest_start: float = 0.05
    contraction: float = 0.25
    least_pivot: float = 1e-5
    pivot_share: float = 4.0
    fold_product: float = 2.0
    least_miss: float = 1e-8
    near: float = 1e-4
    lane_steps: int = 7
    least_damping: float = 1e-14
    damping: float = 1e-3
    largest_step: float = 0.3
    converged: float = 1e-13
    patience: int = 5
    progress: float = 0.8
    refinement: tuple[RefineStage, ...] = REFINEMENT
