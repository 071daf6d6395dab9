"""The robots of the IKBT paper and its repository: derive, emit, and count solutions.

    python -m benchmarks.suite [--robot TEXT] [--task chosen] [--poses N] [--searched N] [--starts N]
        [--json] [--record]
    python -m benchmarks.suite --prove

Prints one row a robot: how it was solved, how many solutions each pose has by the emitted Python
module and by an independent numerical search, how many rows were wrong and how many missed. A row
is wrong if forward kinematics does not give the pose back; a generating configuration or a solution
of the search is missed if no row equals it. Claimed is the number of solutions that the module claims,
most the largest at as many random and as many special poses (with `--poses 10000` they are equal).
Below stand the paper's own tables beside what ikgen finds. As in the paper, arms with fewer than six joints
take a whole pose; with `--task chosen` each takes what ikgen chooses for it, what it can do everywhere.
Exits with 1 if any row was wrong or missed.

With `--prove` the derivations are proved in exact arithmetic instead, for every pose. Exits with 1 if one
of a table that rules solve is not proved.
"""

from __future__ import annotations

import argparse
import json
import statistics
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.paper_tables import comparison
from benchmarks.results import write_result
from ikgen.derivation.derive import derive
from ikgen.emit.derivation import Derivation
from ikgen.emit.python.python_emitter import emit_module
from ikgen.errors import IkgenError
from ikgen.generation.emitted_checks import oracle_for
from ikgen.records.request import Request
from ikgen.tasks import find_task
from ikgen.verify.arm import REGULAR_SIGMA, ArmUnderTest, arm_under_test
from ikgen.verify.runners.python_module import PythonModule
from ikgen.verify.search import find_solutions
from ikgen.verify.task_space import task_space

TABLES = Path(__file__).resolve().parents[1] / "tests" / "robots" / "tables"
Array = NDArray[np.float64]
SAME = 1e-5  # rad, or lengths of the arm
WRONG = 1e-8


@dataclass(frozen=True, slots=True)
class Trial:
    """What came of one robot. `found` and `true` count solutions a pose; `true` is the search's. `claimed`
    is the number that the module claims, `most` the largest of any pose, special ones among them."""

    robot: str
    dof: int
    kinds: str
    state: str
    seconds: float
    leaves: str
    found: str
    true: str
    wrong: int
    missed: int
    note: str
    order: tuple[str, ...] = ()
    claimed: int = 0
    most: int = 0


def tables(part: str = "") -> list[Path]:
    """The DH tables whose name contains `part`."""
    return sorted(p for p in TABLES.glob("*.toml") if part.lower() in p.stem.lower())


def try_robot(
    path: Path, poses: int, searched: int, starts: int, task: str | None = "pose"
) -> Trial:
    """Derive, emit and check one robot, for a task or for the one that ikgen chooses."""
    started = time.perf_counter()
    try:
        derivation = derive(Request(path, task=task))
        text = emit_module(derivation.module)
    except IkgenError as error:
        from ikgen.importers.dh.dh_table import read_dh_table

        seconds = time.perf_counter() - started
        source, dh = read_dh_table(path)
        note = "; ".join(n for n in source.warnings if "infinitely" in n) or error.message
        state = "redundant" if "infinitely" in note else "unsolved"
        kinds = "".join("R" if row.revolute else "P" for row in dh.rows)
        return Trial(path.stem, dh.dof, kinds, state, seconds, "", "", "", 0, 0, note)
    seconds = time.perf_counter() - started
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / f"{derivation.module.name}_ik.py"
        file.write_text(text, encoding="utf-8")
        module = PythonModule(file).module
        try:
            return _check(path.stem, derivation, module, seconds, (poses, searched, starts))
        except Exception as error:  # a robot whose module raises must not end the run
            kinds = derivation.geometry.kinds
            note = f"{type(error).__name__}: {error}"
            return Trial(path.stem, len(kinds), kinds, "broken", seconds, "", "", "", 1, 0, note)


def _check(
    robot: str, derivation: Derivation, module: Any, seconds: float, sizes: tuple[int, int, int]
) -> Trial:
    poses, searched, starts = sizes
    arm = _arm(derivation)
    rng = np.random.default_rng(20180513)
    held = derivation.module.free_defaults
    q = _regular(arm, rng, poses, held)
    T = arm.oracle.forward(q)
    rows, count, _ = module.solve_batch(T, limits=False)
    wrong, missed = _compare(arm, rows, count, T, q)
    true: Counter[int] = Counter()
    for i, found in enumerate(find_solutions(arm, T[:searched], q[:searched], starts, rng)):
        distinct = _distinct(arm, found)
        true[len(distinct)] += 1
        missed += sum(not _present(arm, rows[i, : count[i]], one) for one in distinct)
    graph = derivation.graph
    leaves = Counter(step.candidate.leaf for step in graph.steps)
    return Trial(
        robot=robot,
        dof=arm.dof,
        kinds="".join("R" if row.revolute else "P" for row in derivation.reading.dh.rows),
        state="solved",
        seconds=seconds,
        leaves=""
        if derivation.module.plan
        else ", ".join(f"{n} {name}" for name, n in leaves.items()),
        found=_histogram(Counter(int(c) for c in count)),
        true=_histogram(true),
        wrong=wrong,
        missed=missed,
        note=derivation.geometry.name,
        order=derivation.module.order,
        claimed=module.MAX_SOLUTIONS,
        most=max(int(count.max()), _most_at_special_poses(arm, module, rng, poses, held)),
    )


def _most_at_special_poses(
    arm: ArmUnderTest, module: Any, rng: np.random.Generator, poses: int, held: tuple[float, ...]
) -> int:
    """The most solutions at a pose with some joints at multiples of 90 degrees and slides at 0: there the
    poses of an arm with fewer than six joints cross, which are single elsewhere."""
    q = arm.uniform(rng, poses)
    quarters = np.where(arm.revolute, rng.integers(-1, 3, q.shape) * (np.pi / 2), 0.0)
    q = np.where(rng.random(q.shape) < rng.random((poses, 1)), quarters, q)
    q[:, list(arm.free)] = held
    return int(module.solve_batch(arm.oracle.forward(q), limits=False)[1].max())


def prove_robot(path: Path) -> tuple[str, str]:
    """What is said about the proof of a table, and its state."""
    from ikgen.symbolic import prove

    started = time.perf_counter()
    try:
        derivation = derive(Request(path))
    except IkgenError as error:
        return f"{path.stem:16} not solved: {error.message}", "not solved"
    derived = time.perf_counter()
    proof = prove(derivation)
    seconds = f"{derived - started:5.1f} s, {time.perf_counter() - derived:5.2f} s"
    lines = [f"{path.stem:16} {seconds}  {proof.words}", *(f"    {r}" for r in proof.remarks)]
    state = "proved" if proof.proved else "solved by elimination" if proof.reason else "NOT PROVED"
    return "\n".join(lines), state


def _prove_all(part: str) -> int:
    """Prints the proofs; the exit code."""
    started = time.perf_counter()
    print(f"{'robot':16} derived, proved")
    states: Counter[str] = Counter()
    for path in tables(part):
        line, state = prove_robot(path)
        print(line, flush=True)
        states[state] += 1
    words = ", ".join(f"{n} {state}" for state, n in states.items())
    print(f"\n{states.total()} robots: {words}; {time.perf_counter() - started:.0f} s")
    return int("NOT PROVED" in states)


def _arm(derivation: Derivation) -> ArmUnderTest:
    dh = derivation.reading.dh
    bounds = np.full(dh.dof, -np.inf), np.full(dh.dof, np.inf)
    return arm_under_test(
        oracle_for(derivation.reading),
        task_space(find_task(derivation.module.task)),
        bounds,
        dh.free,
    )


def _regular(
    arm: ArmUnderTest, rng: np.random.Generator, poses: int, held: tuple[float, ...]
) -> Array:
    """Random configurations (poses, dof) away from singularities, held joints at their defaults."""
    q = arm.uniform(rng, 4 * poses)
    q[:, list(arm.free)] = held
    return q[arm.sigma(q) > REGULAR_SIGMA][:poses]


def _compare(arm: ArmUnderTest, rows: Array, count: Array, T: Array, q: Array) -> tuple[int, int]:
    """How many rows do not give their pose back; how many poses lack their configuration."""
    wrong = missed = 0
    for i, k in enumerate(count):
        back = arm.oracle.forward(rows[i, :k]) if k else np.zeros((0, 4, 4))
        error = arm.task.residual(back, np.broadcast_to(T[i], back.shape))
        wrong += int(
            np.sum(np.max(np.abs(error), axis=-1, initial=0.0) > WRONG * max(1.0, arm.length))
        )
        missed += not _present(arm, rows[i, :k], q[i])
    return wrong, missed


def _scaled(arm: ArmUnderTest, a: Array, b: Array) -> Array:
    d = np.abs(arm.difference(a, b))
    return np.asarray(np.max(np.where(arm.revolute, d, d / arm.length), axis=-1, initial=0.0))


def _present(arm: ArmUnderTest, rows: Array, q: Array) -> bool:
    return bool(len(rows) and np.min(_scaled(arm, rows, q)) < SAME)


def _distinct(arm: ArmUnderTest, found: Array) -> list[Array]:
    """Regular solutions, each once."""
    out: list[Array] = []
    for one in found[arm.sigma(found) > REGULAR_SIGMA / 10] if len(found) else found:
        if not out or np.min(_scaled(arm, np.array(out), one)) > 10 * SAME:
            out.append(one)
    return out


def _histogram(counts: Counter[int]) -> str:
    return " ".join(f"{n}x{k}" if k > 1 else f"{n}" for n, k in sorted(counts.items()))


def _print(trials: Sequence[Trial]) -> None:
    head = f"{'robot':16} {'joints':7} {'state':9} {'s':>5}  {'found':24} {'true':14}"
    print(f"{head} wrong missed claimed most  leaves")
    for t in trials:
        print(
            f"{t.robot:16} {t.kinds:7} {t.state:9} {t.seconds:5.1f}  {t.found:24} {t.true:14} "
            f"{t.wrong:5} {t.missed:6} {t.claimed:7} {t.most:4}  {t.leaves or t.note}"
        )
    solved = [t for t in trials if t.state == "solved"]
    states = Counter(t.state for t in trials)
    print(
        f"\n{len(trials)} robots: {', '.join(f'{n} {s}' for s, n in states.items())}; "
        f"{sum(t.wrong for t in trials)} rows wrong, {sum(t.missed for t in trials)} missed; "
        f"median {statistics.median(t.seconds for t in solved or trials):.2f} s\n"
    )
    facts = [(t.robot, t.dof, t.seconds if t in solved else None, t.order) for t in trials]
    print("\n".join(comparison(facts)))


def _recorded(trials: Sequence[Trial]) -> dict[str, Any]:
    """What the README shows; what the elimination solves has no leaves."""
    solved = [t for t in trials if t.state == "solved"]
    seconds = [round(t.seconds, 2) for t in solved] or [0.0]
    return {
        "tables": len(trials),
        "by_rules": sum(bool(t.leaves) for t in solved),
        "by_elimination": sum(not t.leaves for t in solved),
        "wrong": sum(t.wrong for t in trials),
        "missed": sum(t.missed for t in trials),
        "median": statistics.median(seconds),
        "longest": max(seconds),
    }


def main(arguments: Sequence[str] | None = None) -> int:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--robot", default="", help="only robots whose name contains this")
    parser.add_argument("--task", choices=("pose", "chosen"), default="pose",
                        help="chosen: by ikgen, for each robot")  # fmt: skip
    parser.add_argument("--poses", type=int, default=200, help="random poses a robot (1000: full)")
    parser.add_argument("--searched", type=int, default=3, help="poses searched numerically")
    parser.add_argument("--starts", type=int, default=300, help="starts of the search, per pose")
    parser.add_argument("--json", action="store_true", help="machine-readable rows")
    parser.add_argument("--record", action="store_true", help="write it to results/")
    parser.add_argument("--prove", action="store_true", help="prove the derivations instead")
    options = parser.parse_args(arguments)
    if options.prove:
        return _prove_all(options.robot)
    if options.record and options.robot:
        parser.error("--record is for all tables")
    sizes = options.poses, min(options.searched, options.poses), options.starts
    task = "pose" if options.task == "pose" else None
    trials = [try_robot(path, *sizes, task) for path in tables(options.robot)]
    if options.json:
        print(json.dumps([asdict(t) for t in trials], indent=2))
    else:
        _print(trials)
    if options.record:
        said = "" if task else " --task chosen"
        command = f"python -m benchmarks.suite{said} --poses {options.poses}"
        write_result("suite" if task else "suite_chosen", command, _recorded(trials))
    return int(any(t.wrong or t.missed for t in trials))


if __name__ == "__main__":
    sys.exit(main())
