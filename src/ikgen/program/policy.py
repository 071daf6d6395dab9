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
    """Tolerances and counts of `solve`, the same in every language.

    - `arrived`: error (rad, or m over the arm's size) below which refined rows are solutions, `exact`:
      below which they give way to no better ones nearby; `rough_square`: squared error above which a row
      is refined.
    - `pose_tolerance`: how far a rotation's entries may be off; nearer ones are replaced by the nearest
      rotation; `orthonormal`: what is round-off of them; `level`: by how much the squared length of a
      heading may be short of 1.
    - `coincident`: rows closer than that (rad or m) are one, singular ones closer than `alike` where
      the pose is theirs to `halfway` between them too; of other singular ones that are `alike` at most
      `crowd` are kept, as many as solutions meet at a point where two folds do; `meeting`: how close
      branches are where their rows are compared. `limit_tolerance`: a row that far (rad or m) outside a
      limit is put back on it, and one that far, `limit_reach`, where its pose does not tell that it is
      outside, which Newton steps find out.
    - `tries`: how many values of a joint that a pose leaves free are tried, `try_step` (rad) apart.
    - `singular_below`: smallest singular value below which a refined row is singular; `continuum_below`
      where the Program marked it already.
    - `fold_reach`: smallest singular value below which another solution may be so near that the closed form
      does not find it for itself.
    - `beside_reach`: smallest singular value below which poses beside are solved as well, `anywhere` where
      they always are; `fold`: these two over the root of how far the file is off. `broken_reach`: smallest
      singular value below which a row may lie on a continuum that rounding broke, over how far the file is
      off: along it the error is as small as that, and so is its slope.
    - `farthest_start`: the largest first step (rad, m) of rows that are refined together, `contraction`:
      the most that a step of theirs may be of the one before, `least_pivot`: how far the derivatives by a
      joint must be from the span of others', `pivot_share`: the most that a first step may be of that
      distance, unless the two smallest singular values have a product above `fold_product` times what the
      file is off, as no other solution comes in there then, `least_miss`: the error that shows that they
      end beside the pose, `near`: the largest step in C++ behind which the derivatives stay, `lane_steps`:
      how many they take at most; other rows are refined one by one.
    - `least_damping`, `damping`: a Newton step is damped by max(least, damping * error^2); `largest_step`
      (rad or m) bounds each joint's; `converged`: error at which steps end; `patience` steps may pass
      without the error falling to `progress` of what it was.
    """

    arrived: float = 0.5e-9
    exact: float = 1e-12
    rough_square: float = 1e-24
    pose_tolerance: float = 1e-6
    orthonormal: float = 1e-14
    level: float = LEVEL
    coincident: float = 1e-6
    alike: float = 1e-2
    halfway: float = 2e-14
    crowd: int = 4
    meeting: float = 2e-5
    limit_tolerance: float = 1e-9
    limit_reach: float = 1e-5
    tries: int = 16
    try_step: float = 0.39269908169872414
    singular_below: float = 1e-7
    continuum_below: float = 1e-3
    fold_reach: float = 1e-4
    beside_reach: float = 0.0
    fold: float = 0.3
    fold_product: float = 2.0
    anywhere: float = 1e3
    broken_reach: float = 15.0
    farthest_start: float = 0.05
    contraction: float = 0.25
    pivot_share: float = 4.0
    least_pivot: float = 1e-5
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
