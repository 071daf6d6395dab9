"""What the rows of an arm's solutions are told apart by."""

from __future__ import annotations

from ikgen.emit.solver_module import SolverModule
from ikgen.kinematics.classify import GeometryClass, classify

__all__ = ["branch_kind", "elbow_end"]

_SIDES = 8
"""Rows of an arm of which shoulder, elbow and wrist have two sides each."""


def branch_kind(module: SolverModule) -> str:
    """ "names" (shoulder, elbow, wrist), "number" (of the closed form's branch), or "orientation" (of the
    Jacobian), as `ikgen.runtime.python.rows.row_branches` has them."""
    if module.plan is not None:
        return "orientation"
    return "names" if _has_sides(module) else "number"


def elbow_end(module: SolverModule) -> int:
    """The axis (from 0) that the third one turns about itself and whose place decides the elbow's side: the
    fourth of three parallel ones, else that on which the wrist's axes meet."""
    return 3 if 2 in classify(module.dh).parallel_triples else 5


def _has_sides(module: SolverModule) -> bool:
    """Whether it is an upright elbow arm: the first axis at right angles to the second and third, which are
    parallel; then a spherical wrist, or a third parallel axis and two that meet at right angles."""
    dh, geometry = module.dh, classify(module.dh)
    plain = module.reads.whole_pose and not module.free_indices and dh.dof == len(dh.rows) == 6
    if not plain or geometry.kinds != "RRRRRR" or module.lanes != _SIDES:
        return False
    shoulder = 1 in geometry.perpendicular_pairs and 2 in geometry.parallel_pairs
    return shoulder and (4 in geometry.spherical_triples or _three_parallel(geometry))


def _three_parallel(geometry: GeometryClass) -> bool:
    wrist = {4, 5} <= set(geometry.intersecting_pairs)
    return 2 in geometry.parallel_triples and wrist
