"""Checks of what emitted code does beyond a pose: paths, and what is held chosen by the solver."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from ikgen.model.arrays import Array
from ikgen.verify.arm import ArmUnderTest
from ikgen.verify.checks import CLOSURE_TOLERANCE
from ikgen.verify.runners.runner import MovingRunner
from ikgen.verify.trials import result, spell
from ikgen.verify.verification_report import CheckResult

__all__ = [
    "Motions",
    "check_follow",
    "check_search",
    "check_self_motion",
    "motion_checks",
    "regular_motions",
]


REGULAR_ON_PATH = 0.05  # smallest singular value
FOUND = 1e-6  # rad or m
_MOTIONS, _SEARCHES, _DRAWN = 15, 3, 600
_GRIDS = 1
"""Searches over grids of several held joints, which take seconds each in Python."""

_FARTHEST = 0.2
"""rad, or m and of the arm's length, that a joint or what follows it moves between two poses."""

_MARGIN = 0.5  # of that, from the limits
_BETWEEN = 9  # configurations that are looked at


@dataclass(frozen=True, slots=True)
class Motions:
    """Regular motions inside the limits: `start` and `end` (N, dof), and their `poses` (N, 2, 4, 4)."""

    start: Array
    end: Array
    poses: Array


def regular_motions(arm: ArmUnderTest, rng: np.random.Generator) -> Motions:
    """A few random ones, clear of the limits, as what lies between the poses is not the motion but about
    half of its square beside it; none of an arm that is nowhere clearly regular."""
    start = arm.uniform(rng, _DRAWN)
    most = np.where(arm.revolute, _FARTHEST, _FARTHEST * min(1.0, arm.length)) / arm.fastest
    room = 0.1 * (arm.upper - arm.lower)
    most = most * min(1.0, float(np.sqrt(2.0 * np.min(room))) / _FARTHEST)
    end = start + rng.uniform(-most, most, start.shape)
    share = np.linspace(0.0, 1.0, _BETWEEN)[:, None, None]
    sigma = arm.sigma((start + share * (end - start)).reshape(-1, arm.dof))
    margin = np.minimum(_MARGIN * most, room)
    clear = arm.within(start, -margin) & arm.within(end, -margin)
    regular = np.flatnonzero(clear & (sigma.reshape(_BETWEEN, -1).min(axis=0) > REGULAR_ON_PATH))
    start, end = start[regular[:_MOTIONS]], end[regular[:_MOTIONS]]
    poses = np.stack([arm.oracle.forward(start), arm.oracle.forward(end)], axis=1)
    return Motions(start, end, poses)


def motion_checks(
    arm: ArmUnderTest, runner: MovingRunner, motions: Motions
) -> dict[str, Callable[[], CheckResult]]:
    """The checks by name, of what the emitted code has."""
    checks = {"paths": check_follow, "search": check_search}
    if arm.held and runner.has_self_motion:
        checks["self motion"] = check_self_motion
    return {name: partial(check, arm, runner, motions) for name, check in checks.items()}


def check_follow(arm: ArmUnderTest, runner: MovingRunner, motions: Motions) -> CheckResult:
    """A path from one end of a regular motion to the other is followed, by an arm without held joints as
    the motion went, and nowhere across a singularity if its joints are as many as what the task fixes; the
    first row, which is the motion's, is not at one either way."""
    failures, worst, case = 0, 0.0, ""
    square = len(arm.active) == arm.dof == arm.rank
    for i, (start, end, poses) in enumerate(
        zip(motions.start, motions.end, motions.poses, strict=True)
    ):
        q, status, singular = runner.follow(poses, start)
        off = 0.0 if arm.held else float(arm.distance(q[-1], end))
        crossed = bool(singular.any() if square else singular[0])
        right = status == "OK" and off <= FOUND and not crossed
        if not (right and _closes(arm, q, poses)):
            failures += 1
            case = case or spell("motion", i, start=start, end=end, followed=q)
        worst = max(worst, off)
    return result("paths", len(motions.start), failures, (("off rad or m", worst),), "", case)


def check_search(arm: ArmUnderTest, runner: MovingRunner, motions: Motions) -> CheckResult:
    """The best row near a configuration at its pose is that configuration, and no row comes twice, but of
    one held joint's intervals, which may have one best row where they meet."""
    failures, worst, case = 0, 0.0, ""
    count = _SEARCHES if len(arm.held) < 2 else _GRIDS
    some = list(zip(motions.start, motions.poses[:, 0], strict=True))[:count]
    for i, (q, pose) in enumerate(some):
        rows = runner.search(pose, q)
        off = float(arm.distance(rows[0], q)) if len(rows) else np.inf
        right = off <= FOUND and _closes(arm, rows, np.repeat(pose[None], len(rows), axis=0))
        if not right or (len(arm.held) != 1 and _repeated(arm, rows)):
            failures += 1
            case = case or spell("motion", i, q=q, pose=pose, rows=rows)
        worst = max(worst, off)
    return result("search", len(some), failures, (("off rad or m", worst),), "", case)


def check_self_motion(arm: ArmUnderTest, runner: MovingRunner, motions: Motions) -> CheckResult:
    """A configuration's value of what is held lies in an interval of its pose."""
    failures, case = 0, ""
    q, poses = motions.start[:_SEARCHES], motions.poses[:_SEARCHES, 0]
    held = arm.held_values(q, poses)
    assert held is not None
    for i, (pose, value) in enumerate(zip(poses, held[:, 0], strict=True)):
        ends = runner.self_motion(pose)
        if not ((ends[:, 0] - FOUND <= value) & (value <= ends[:, 1] + FOUND)).any():
            failures += 1
            case = case or spell("motion", i, q=q[i], pose=pose, intervals=ends)
    return result("self motion", len(q), failures, (), "", case)


def _repeated(arm: ArmUnderTest, rows: Array) -> bool:
    """Whether some of rows (N, dof) are the same."""
    first, second = np.triu_indices(len(rows), 1)
    return bool((arm.distance(rows[first], rows[second]) <= FOUND).any())


def _closes(arm: ArmUnderTest, q: Array, poses: Array) -> bool:
    """Whether rows (N, dof) have their poses (N, 4, 4)."""
    position, rotation = arm.task.errors(arm.oracle.forward(q), poses)
    error = np.maximum(position / arm.size_of(q), rotation)
    return bool(np.all(error <= CLOSURE_TOLERANCE))
