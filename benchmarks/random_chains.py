"""Random chains by the rules: the share solved, and whether what was solved is right and complete.

    python -m benchmarks.random_chains [--count N] [--poses N] [--seed N] [--record]

Modified DH tables of 3 to 6 joints, revolute and prismatic mixed, twists of 0 and ±90 degrees, about
half of the lengths zero. Arms whose joints are not independent (a smaller rank than joints) are drawn
again: they have infinitely many solutions.
"""

from __future__ import annotations

import argparse
import importlib.util
import itertools
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Sequence
from fractions import Fraction
from pathlib import Path
from types import ModuleType

import numpy as np

from benchmarks.results import write_result
from ikgen.emit.python.python_emitter import emit_module
from ikgen.emit.solver_module import SolverModule
from ikgen.equations.probes import arm_size, dh_pose, smallest_singular
from ikgen.lowering.lower import lower
from ikgen.model.chain import PRISMATIC, REVOLUTE, ActuatedJoint
from ikgen.model.dh import Angle, DHChain, DHRow, Length
from ikgen.model.joint_tree import Limits
from ikgen.solver.solve import solve_chain

QUARTERS = (Fraction(0), Fraction(1, 2), Fraction(-1, 2))
_count = itertools.count()


def _length(rng: np.random.Generator, name: str, zero: float) -> Length:
    if rng.random() < zero:
        return Length(0.0, None)
    return Length(float(rng.uniform(0.2, 1.0)), name)


def random_table(rng: np.random.Generator) -> DHChain:
    """A chain whose joints move its tip independently of each other."""
    while True:
        dh = _draw(rng)
        values = rng.uniform(-2.0, 2.0, (6, dh.dof))
        if np.median(smallest_singular(dh, values, arm_size(dh))) > 1e-3:
            return dh


def _draw(rng: np.random.Generator) -> DHChain:
    n = int(rng.integers(3, 7))
    rows: list[DHRow] = []
    joints: list[ActuatedJoint] = []
    zero = Length(0.0, None)
    straight = Angle(0.0, Fraction(0))
    for i in range(n):
        kind = PRISMATIC if rng.random() < 0.25 else REVOLUTE
        twist = QUARTERS[int(rng.integers(3))] if i else Fraction(0)
        a = _length(rng, f"a_{i}", 0.5) if i else zero
        d = _length(rng, f"d_{i + 1}", 0.6)
        alpha = Angle(float(twist) * np.pi, twist)
        offset: Angle | Length = straight if kind == REVOLUTE else zero
        rows.append(
            DHRow(
                f"q{i + 1}",
                kind,
                alpha,
                a,
                d if kind == REVOLUTE else zero,
                straight,
                i,
                1.0,
                offset,
            )
        )
        joints.append(ActuatedJoint(f"q{i + 1}", kind, Limits(-np.inf, np.inf)))
    frames = _frames(rows)
    eye = np.eye(4)
    return DHChain("random", "base", "tip", tuple(joints), tuple(rows), eye, eye, frames)


def _frames(rows: Sequence[DHRow]) -> tuple[np.ndarray, ...]:
    """`F_0 ... F_n` of the table itself."""
    frames = [np.eye(4)]
    for row in rows:
        frames[-1] = frames[-1] @ _link(row)
        after = np.eye(4)
        after[2, 3] = row.d.value
        frames.append(after)
    return tuple(frames)


def _link(row: DHRow) -> np.ndarray:
    T = np.eye(4)
    c, s = np.cos(row.alpha.value), np.sin(row.alpha.value)
    T[1:3, 1:3] = [[c, -s], [s, c]]
    T[0, 3] = row.a.value
    return T


def pattern(dh: DHChain) -> str:
    """Joint types with what lies between them: = parallel, | at right angles, o no offset."""
    text = ""
    for row in dh.rows:
        text += ("=" if row.alpha.exact == 0 else "|") + ("o" if row.a.name is None else "a")
        text += ("R" if row.revolute else "P") + ("" if row.d.name is None else "d")
    return text[2:]


def load(text: str, folder: Path) -> ModuleType:
    """An emitted module from its text."""
    name = f"random_{next(_count)}_ik"
    path = folder / f"{name}.py"
    path.write_text(text)
    spec = importlib.util.spec_from_file_location(name, path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


def check(dh: DHChain, module: ModuleType, poses: int, rng: np.random.Generator) -> tuple[int, int]:
    """Wrong rows and missed configurations over random regular poses."""
    q = rng.uniform(-2.5, 2.5, (poses, dh.dof))
    regular = smallest_singular(dh, q, arm_size(dh)) > 1e-3
    wrong = missed = 0
    for at, pose in zip(q[regular], dh_pose(dh, q[regular]), strict=True):
        rows = module.solve(pose, limits=False).q
        if len(rows):
            wrong += int((np.abs(module.forward(rows) - pose).max(axis=(1, 2)) > 1e-8).sum())
        turn = np.array([row.revolute for row in dh.rows])
        gap = np.abs(rows - at)
        gap = np.where(turn, np.minimum(gap % (2 * np.pi), -gap % (2 * np.pi)), gap)
        missed += int(not len(rows) or gap.max(axis=1).min() > 1e-6)
    return wrong, missed


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table; 1 if a solved chain is wrong or incomplete."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--poses", type=int, default=100)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--record", action="store_true", help="write results/random_chains.json")
    options = parser.parse_args(arguments)
    rng = np.random.default_rng(options.seed)
    solved: Counter[int] = Counter()
    total: Counter[int] = Counter()
    wrong = missed = 0
    unsolved: list[str] = []
    times: list[float] = []
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(options.count):
            dh = random_table(rng)
            total[dh.dof] += 1
            started = time.perf_counter()
            graph = solve_chain(dh)
            times.append(time.perf_counter() - started)
            if graph.open_joints:
                unsolved.append(pattern(dh))
                continue
            solved[dh.dof] += 1
            module = SolverModule(
                "random", lower(graph), dh, "pose", (), (), "table", "0" * 64, "benchmark"
            )
            bad, lost = check(dh, load(emit_module(module), Path(folder)), options.poses, rng)
            if bad or lost:
                leaves = ", ".join(s.candidate.leaf for s in graph.steps)
                print(f"{pattern(dh)}: {bad} wrong, {lost} missed ({leaves})", flush=True)
            wrong, missed = wrong + bad, missed + lost
    for dof in sorted(total):
        print(f"{dof} joints: {solved[dof]} of {total[dof]} solved by the rules")
    print(f"all: {sum(solved.values())} of {options.count}; {wrong} wrong rows, {missed} missed")
    print(f"seconds: median {np.median(times):.2f}, max {max(times):.2f}")
    for text, number in sorted(Counter(unsolved).items()):
        print(f"not solved: {text} ({number})")
    if options.record:
        found = {
            "tables": options.count, "by_rules": sum(solved.values()), "by_elimination": 0,
            "wrong": wrong, "missed": missed, "median": round(float(np.median(times)), 2),
            "by_joints": {dof: [solved[dof], total[dof]] for dof in sorted(total)},
        }  # fmt: skip
        write_result("random_chains", "python -m benchmarks.random_chains", found)
    return int(wrong + missed > 0)


if __name__ == "__main__":
    raise SystemExit(main())
