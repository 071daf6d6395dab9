"""ikgen's emitted code against other packages, on the same reachable poses and in one process.

    python -m benchmarks.peers ROBOTS_FOLDER [--poses N] [--record]
        [--opw-kinematics INCLUDE] [--ikfast ARM=FILE.cpp]

ROBOTS_FOLDER holds abb_irb2400.urdf, kuka_kr6r900sixx.urdf, ur5e.urdf, franka_panda_erd.urdf, wam.urdf,
doosan_m1013.urdf and fanuc_crx10ia.urdf; an arm whose file is missing is left out. DART's sources hold
wam.urdf and what IKFast wrote of it (joint 3 held), to be given as --ikfast WAM=FILE; the sources of
ikfast-pybind (PyPI) hold what it wrote of KR 6 R900 and Panda (joint 7 held).
Peers are optional: pip install EAIK py-opw-kinematics ssik ikdh pin, of which missing ones are named;
with the sources of opw_kinematics (C++) and of IKFast at hand, their paths add them to the table;
the compiled package needs pip, a C++ compiler and network access for its build tools.
Times are medians over rounds in which the solvers take turns; the slow ones take twenty of the poses.
Recall: the configuration that a pose was made from is among the rows, whole turns aside. ssik lists
whole turns as rows of their own, and chooses the values of a redundant joint itself, so that its
recall on such an arm says nothing.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.cpp_peers import against_ikfast, against_opw
from benchmarks.cpp_speed import FLAGS, measure
from benchmarks.peer_arms import ARMS, compiled, make_arm
from benchmarks.peer_solvers import PEERS, AbsentError, Arm, Array, Solver
from benchmarks.results import write_result


@dataclass(frozen=True)
class Result:
    """One solver on one arm; `microseconds` a pose, None where there is nothing to tell."""

    arm: str
    solver: str
    microseconds: float
    rows: float | None = None
    recall: float | None = None
    error: float | None = None
    singular: str = ""
    unreachable: str = ""


def solvers(arm: Arm, out: Path) -> dict[str, Solver]:
    """What there is to compare; says what is missing."""
    free = list(arm.free) or None

    def native(arm: Arm) -> Solver:
        package = compiled(f"{arm.module.__name__}_ext", out)
        return lambda pose: np.asarray(package.solve(pose, free=free, limits=False).q)

    makers: dict[str, Callable[[Arm], Solver]] = {
        "ikgen, Python": lambda arm: lambda pose: arm.module.solve(pose, free=free, limits=False).q,
        "ikgen, nanobind": native,
    } | PEERS
    found = {}
    for name, make in makers.items():
        try:
            found[name] = make(arm)
        except AbsentError as reason:
            print(f"  {name}: left out, {reason}")
    return found


def configurations(arm: Arm, count: int, rng: np.random.Generator) -> Array:
    """Random joint values inside the limits (count, dof), held joints at their values."""
    low, high = np.maximum(arm.module.LOWER, -np.pi), np.minimum(arm.module.UPPER, np.pi)
    q = rng.uniform(low, high, (count, arm.module.DOF))
    for j, value in arm.held:
        q[:, j] = value
    return q


def run(arm: Arm, named: dict[str, Solver], q: Array) -> list[Result]:
    """All solvers on the poses of q, in turns."""
    poses = arm.module.forward(q)
    times: dict[str, list[float]] = {name: [] for name in named}
    answers: dict[str, list[Array]] = {}
    for _ in range(5):
        for name, solve in named.items():
            few = poses[: 20 if name in ("ssik", "Pinocchio CLIK (one row)") else None]
            for pose in few[:10]:
                solve(pose)  # the caches were another's
            start = time.perf_counter()
            answers[name] = [solve(pose) for pose in few]
            times[name].append((time.perf_counter() - start) / len(few) * 1e6)
    out = []
    for name, rows in answers.items():
        recall = np.mean([contains(a, b) for a, b in zip(rows, q, strict=False)])
        error = max(closure(arm, a, T) for a, T in zip(rows, poses, strict=False))
        counts = float(np.mean([len(a) for a in rows]))
        special = behaviour(arm, named[name])
        median = float(np.median(times[name]))
        out.append(Result(arm.name, name, median, counts, float(recall), error, *special))
    return out


def contains(rows: Array, q: Array) -> bool:
    """Whether q is among the rows to 1e-4, whole turns aside."""
    apart = np.abs((rows - q + np.pi) % (2 * np.pi) - np.pi)
    return bool(len(rows)) and bool((apart.max(axis=1) < 1e-4).any())


def closure(arm: Arm, rows: Array, pose: Array) -> float:
    """Largest error of the rows' poses (m, or entries of the rotation)."""
    return float(np.abs(arm.module.forward(rows) - pose).max()) if len(rows) else 0.0


def behaviour(arm: Arm, solve: Solver) -> tuple[str, str]:
    """What a solver says of a pose with two axes on one line, and of one far outside."""
    q = np.full(arm.module.DOF, 0.3)
    q[1], q[2], q[4] = -0.9, 0.8, 0.0
    for j, value in arm.held:
        q[j] = value
    singular = arm.module.forward(q)
    far = singular.copy()
    far[:3, 3] = 9.0
    words = []
    for pose in (singular, far):
        try:
            rows = solve(pose)
            wrong = sum(closure(arm, row[None], pose) > 1e-6 for row in rows)
            words.append(f"{len(rows)} rows" + (f", {wrong} wrong" if wrong else ""))
        except Exception as error:
            words.append(type(error).__name__)
    return words[0], words[1]


def batched(arm: Arm, q: Array) -> Result:
    """NumPy's arrays, 1000 poses at once."""
    poses = arm.module.forward(np.resize(q, (1000, arm.module.DOF)))
    spans = []
    for _ in range(3):
        start = time.perf_counter()
        arm.module.solve_batch(poses, free=list(arm.free) or None, limits=False)
        spans.append((time.perf_counter() - start) / len(poses) * 1e6)
    return Result(arm.name, "ikgen, NumPy batch", float(np.median(spans)))


def compared(arm: Arm, header: Path, opw: Path | None, ikfast: str | None) -> list[Result]:
    """C++ peers whose sources are given, each in one process with the header."""
    out = []
    for flags in (FLAGS["plain"], FLAGS["native"]):
        pairs = []
        if opw is not None and arm.opw:
            pairs.append(("opw_kinematics, C++ (-O3)", against_opw(header, opw, arm.opw, flags)))
        if ikfast is not None:
            pairs.append(("IKFast, C++ (-O3)", against_ikfast(header, Path(ikfast), flags)))
        for name, c in pairs:
            words = " ".join(flags)
            print(
                f"  {words}: {c.ours:.0f} ns, {name} {c.theirs:.0f} ns, ratio {c.ratio:.2f}; "
                f"rows {c.our_rows:.2f} and {c.their_rows:.2f}"
            )
            if flags == FLAGS["plain"]:
                out.append(Result(arm.name, name, c.theirs / 1000.0))
    return out


def headers(arm: str, header: Path) -> list[Result]:
    """The C++ header with plain -O3, for this machine, and that in batches."""
    _, (single, *_) = measure(header, FLAGS["plain"], limits=False)
    _, (native, batch, *_) = measure(header, FLAGS["native"], limits=False)
    words = " ".join(FLAGS["native"])
    times = {"C++ (-O3)": single, f"C++ ({words})": native, f"C++ batch ({words})": batch}
    return [Result(arm, f"ikgen, {name}", ns / 1000.0) for name, ns in times.items()]


def show(results: list[Result]) -> None:
    """The table."""
    head = f"{'arm':10} {'solver':20} {'us/pose':>9} {'rows':>6} {'recall':>6} {'error':>8}"
    print(f"{head}  singular; unreachable")
    for r in results:
        numbers = "" if r.rows is None else f"{r.rows:6.2f} {r.recall:6.3f} {r.error:8.1e}"
        end = f"  {r.singular}; {r.unreachable}" if r.singular else ""
        print(f"{r.arm:10} {r.solver:20} {r.microseconds:9.2f} {numbers}{end}")


def main() -> None:
    """Measure, print, draw."""
    layout = argparse.RawTextHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=layout)
    parser.add_argument("robots", type=Path)
    parser.add_argument("--poses", type=int, default=200)
    parser.add_argument("--record", action="store_true", help="write results/peers.json")
    parser.add_argument("--opw-kinematics", type=Path, help="its include folder")
    parser.add_argument("--ikfast", action="append", default=[], metavar="ARM=FILE")
    parser.add_argument("--arms", nargs="+", choices=ARMS, default=list(ARMS))
    options = parser.parse_args()
    results: list[Result] = []
    with tempfile.TemporaryDirectory() as folder:
        for name in options.arms:
            print(name)
            try:
                arm, header = make_arm(name, options.robots, Path(folder))
            except AbsentError as reason:
                print(f"  left out, {reason}")
                continue
            q = configurations(arm, options.poses, np.random.default_rng(2))
            results += run(arm, solvers(arm, Path(folder)), q)
            results.append(batched(arm, q))
            results += headers(name, header)
            files = dict(text.split("=", 1) for text in options.ikfast)
            results += compared(arm, header, options.opw_kinematics, files.get(name))
    show(results)
    if options.record:
        times = [
            {"arm": r.arm, "solver": r.solver, "microseconds": float(f"{r.microseconds:.3g}")}
            for r in results
        ]
        write_result("peers", "python -m benchmarks.peers", {"times": times})


if __name__ == "__main__":
    main()
