"""Which share of reachable poses other packages and ikgen's emitted code answer; no times are taken.

    python -m benchmarks.peer_answers ROBOTS_FOLDER [--poses N] [--record]

Folder and packages are those of benchmarks.peers; the poses are those of random configurations inside the
limits. Answered: some row takes the tip to the pose to 1e-6 (m, and entries of the rotation). Found: the
configuration that the pose was made from is among the rows to 1e-4, whole turns aside; nothing is told
of who gives one row alone, or chooses the value of the held joint.
"""

from __future__ import annotations

import argparse
import tempfile
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from benchmarks.peer_arms import ARMS, make_arm
from benchmarks.peer_solvers import PEERS, AbsentError, Arm, Array, Solver
from benchmarks.peers import closure, configurations, contains
from benchmarks.results import write_result

__all__ = ["Answers", "answers"]

_EXACT = 1e-6
_CHOOSES = "ssik"
"""Who chooses the value of a redundant joint."""


@dataclass(frozen=True, slots=True)
class Answers:
    """Shares of the `poses` that one solver answers and finds, and the mean number of right rows."""

    arm: str
    solver: str
    poses: int
    answered: float
    found: float | None
    rows: float


def answers(arm: Arm, name: str, solve: Solver, q: Array) -> Answers:
    """Of one solver on the poses of configurations `q` (n, dof)."""
    poses = arm.module.forward(q)
    right = [_right(arm, solve(pose), pose) for pose in poses]
    known = "one row" not in name and not (name == _CHOOSES and arm.free)
    found = float(np.mean([contains(rows, row) for rows, row in zip(right, q, strict=True)]))
    return Answers(
        arm.name, name, len(q), float(np.mean([len(rows) > 0 for rows in right])),
        found if known else None, round(float(np.mean([len(rows) for rows in right])), 2),
    )  # fmt: skip


def _right(arm: Arm, rows: Array, pose: Array) -> Array:
    """The rows that take the tip to the pose."""
    return np.array([row for row in rows if closure(arm, row[None], pose) < _EXACT]).reshape(
        -1, arm.module.DOF
    )


def of_arm(arm: Arm, count: int) -> list[Answers]:
    """Of every solver that covers the arm; says who does not."""
    q = configurations(arm, count, np.random.default_rng(2))
    free = list(arm.free) or None
    made = [answers(arm, "ikgen", lambda T: arm.module.solve(T, free=free, limits=False).q, q)]
    for name, make in PEERS.items():
        try:
            made.append(answers(arm, name, make(arm), q))
        except AbsentError as reason:
            print(f"  {name}: left out, {reason}")
    return made


def main() -> None:
    """Count and print."""
    layout = argparse.RawTextHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=layout)
    parser.add_argument("robots", type=Path)
    parser.add_argument("--poses", type=int, default=500)
    parser.add_argument("--record", action="store_true", help="write results/peer_answers.json")
    parser.add_argument("--arms", nargs="+", choices=ARMS, default=list(ARMS))
    options = parser.parse_args()
    made: list[Answers] = []
    with tempfile.TemporaryDirectory() as folder:
        for name in options.arms:
            print(name, flush=True)
            try:
                arm, _ = make_arm(name, options.robots, Path(folder))
            except AbsentError as reason:
                print(f"  left out, {reason}")
                continue
            for one in of_arm(arm, options.poses):
                made.append(one)
                found = "" if one.found is None else f", found {one.found:.3f}"
                print(f"  {one.solver:30} answered {one.answered:.3f}{found}, {one.rows} rows")
    if options.record:
        found = {"answers": [asdict(one) for one in made]}
        write_result("peer_answers", "python -m benchmarks.peer_answers", found)


if __name__ == "__main__":
    main()
