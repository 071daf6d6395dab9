"""Random chains: the share solved, and whether what was solved is right and complete.

    python -m benchmarks.random_chains [--count N] [--first N] [--poses N] [--search N] [--seed N]
        [--joints N] [--slides N] [--any-angle] [--command-line] [--emit python,cpp] [--record]

Modified DH tables of 3 to 6 joints, revolute and prismatic mixed, twists of 0 and ±90 degrees, about
half of the lengths zero; or of `--joints` of which `--slides` are prismatic, `--any-angle` with arbitrary
twists. Arms whose joints are not independent (a smaller rank than joints) are drawn again: they have
infinitely many solutions. What the rules leave goes on to the eliminations, where six joints move.
`--command-line` takes each through `ikgen from-dh` with its whole verification, special poses included.
`--first` starts at a later table of the same drawing, so that a long run may be done in pieces.
`--search` compares the solutions of so many poses a table with those of an independent search: Newton's
method from many random starts.
"""

from __future__ import annotations

import argparse
import importlib.util
import itertools
import re
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from types import ModuleType

import numpy as np

from benchmarks.drawn import revolute
from benchmarks.random_tables import Drawn, pattern, random_table, table_text
from benchmarks.results import write_result
from benchmarks.solution_search import apart, searched
from ikgen.elimination import elimination_plan
from ikgen.emit.python.python_emitter import emit_module
from ikgen.emit.solver_module import SolverModule
from ikgen.equations.probes import arm_size, dh_pose, smallest_singular
from ikgen.lowering.elimination_program import elimination_program
from ikgen.lowering.lower import lower
from ikgen.model.dh import DHChain
from ikgen.solver.solve import solve_chain
from ikgen.tasks import find_task
from ikgen.verify.task_space import task_space

RULES, ELIMINATION, NEITHER = "rules", "elimination", "nothing"
_count = itertools.count()


@dataclass(slots=True)
class Tally:
    """What came of the tables."""

    ways: Counter[str] = field(default_factory=Counter)
    solved: Counter[int] = field(default_factory=Counter)
    total: Counter[int] = field(default_factory=Counter)
    wrong: int = 0
    missed: int = 0
    refused: int = 0
    times: list[float] = field(default_factory=list)
    unsolved: list[str] = field(default_factory=list)


def load(path: Path) -> ModuleType:
    """An emitted module from its file."""
    name = f"random_{next(_count)}_ik"
    spec = importlib.util.spec_from_file_location(name, path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


def derived(dh: DHChain, folder: Path) -> tuple[str, Path | None]:
    """How the chain was solved, and the emitted module's file."""
    facts = ("pose", (), (), "table", "0" * 64, "benchmark")
    graph, path = solve_chain(dh), folder / f"random_{next(_count)}.py"
    if not graph.open_joints:
        path.write_text(emit_module(SolverModule("random", lower(graph), dh, *facts)))
        return RULES, path
    plan = elimination_plan(dh)
    if plan is None:
        return NEITHER, None
    module = SolverModule("random", elimination_program(dh, plan.most), dh, *facts, plan=plan)
    path.write_text(emit_module(module))
    return ELIMINATION, path


def through_command_line(dh: DHChain, folder: Path, emit: str) -> tuple[str, Path | None, str]:
    """The same by `ikgen from-dh` with its verification, and what it said of it."""
    name = f"drawn{next(_count)}"
    table = folder / f"{name}.toml"
    table.write_text(table_text(dh, name))
    command = [sys.executable, "-m", "ikgen", "from-dh", str(table), "--output", str(folder)]
    done = subprocess.run([*command, "--emit", emit], capture_output=True, text=True)
    lines = (done.stdout + done.stderr).splitlines()
    said = " | ".join(x.strip() for x in lines if re.match(r"(verified|error|solutions):", x))
    path = folder / f"{name}_ik.py"
    if done.returncode == 3:
        return NEITHER, None, said
    way = ELIMINATION if any("elimination)" in x for x in lines) else RULES
    return way, path if done.returncode == 0 else None, said


def check(dh: DHChain, module: ModuleType, poses: int, rng: np.random.Generator) -> tuple[int, int]:
    """Wrong rows, by what the module's task reads, and missed configurations over random regular poses."""
    q = rng.uniform(-2.5, 2.5, (poses, dh.dof))
    regular = smallest_singular(dh, q, arm_size(dh)) > 1e-3
    task = find_task(module.TASK, getattr(module, "TOOL_AXIS", None))
    turning, space = revolute(module), task_space(task)
    wrong = missed = 0
    for at, pose in zip(q[regular], dh_pose(dh, q[regular]), strict=True):
        rows = module.solve(pose, limits=False).q
        back = module.forward(rows).reshape(-1, 4, 4)
        error = np.abs(space.residual(back, np.broadcast_to(pose, back.shape)))
        wrong += int((error.max(axis=-1, initial=0.0) > 1e-8).sum())
        missed += int(not len(rows) or apart(at, rows, turning).min() > 1e-6)
    return wrong, missed


def compare(dh: DHChain, module: ModuleType, poses: int, rng: np.random.Generator) -> int:
    """Solutions of random regular poses that the independent search finds and the module does not; poses at
    which their numbers differ are printed."""
    q = rng.uniform(-2.0, 2.0, (4 * poses, dh.dof))
    q = q[smallest_singular(dh, q, arm_size(dh)) > 1e-2][:poses]
    turning, missed = revolute(module), 0
    for pose in dh_pose(dh, q):
        rows = module.solve(pose, limits=False).q
        found = searched(module, pose, rng, 3.0 * arm_size(dh))
        lost = sum(not len(rows) or apart(x, rows, turning).min() > 1e-4 for x in found)
        if lost or len(found) != len(rows):
            print(
                f"{pattern(dh)}: {len(rows)} solutions, {len(found)} by search, {lost} of them lost"
            )
        missed += lost
    return missed


def one_table(
    dh: DHChain, folder: Path, options: argparse.Namespace, seed: int, tally: Tally
) -> None:
    """Derive, check and compare one table."""
    started, said = time.perf_counter(), ""
    if options.command_line:
        way, path, said = through_command_line(dh, folder, options.emit)
    else:
        way, path = derived(dh, folder)
    tally.times.append(time.perf_counter() - started)
    tally.ways[way] += 1
    tally.total[dh.dof] += 1
    if path is None:
        tally.refused += way != NEITHER
        tally.unsolved.append(pattern(dh))
        print(f"{pattern(dh)}: {way} {said}", flush=True)
        return
    tally.solved[dh.dof] += 1
    rng = np.random.default_rng(seed)
    if said:
        print(f"{pattern(dh)}: {way} {said}", flush=True)
    module = load(path) if path.exists() else None
    if module is None:
        return
    bad, lost = check(dh, module, options.poses, rng)
    if module.TASK == "pose":
        lost += compare(dh, module, options.search, rng)
    if bad or lost:
        print(f"{pattern(dh)}: {bad} wrong, {lost} missed ({way})", flush=True)
    tally.wrong, tally.missed = tally.wrong + bad, tally.missed + lost


def parsed(arguments: Sequence[str] | None) -> argparse.Namespace:
    """The options."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--first", type=int, default=0, help="tables to draw and leave out")
    parser.add_argument("--poses", type=int, default=100)
    parser.add_argument("--search", type=int, default=0, help="poses to compare with a search")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--joints", type=int, help="as many joints (default: 3 to 6)")
    parser.add_argument("--slides", type=int, help="as many of them prismatic (default: a quarter)")
    parser.add_argument("--any-angle", action="store_true", help="twists that are no right angles")
    parser.add_argument("--command-line", action="store_true", help="through `ikgen from-dh`")
    parser.add_argument("--emit", default="python", help="what it writes")
    parser.add_argument("--record", action="store_true", help="write results/random_chains.json")
    return parser.parse_args(arguments)


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table; 1 if a solved chain is wrong or incomplete."""
    options, tally = parsed(arguments), Tally()
    rng = np.random.default_rng(options.seed)
    least, most = (options.joints, options.joints) if options.joints else (3, 6)
    drawn = Drawn(least, most, options.slides, options.any_angle)
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(options.first):
            random_table(rng, drawn)
        for number in range(options.first, options.first + options.count):
            one_table(random_table(rng, drawn), Path(folder), options, number, tally)
    for dof in sorted(tally.total):
        print(f"{dof} joints: {tally.solved[dof]} of {tally.total[dof]} solved")
    print(
        f"by rules {tally.ways[RULES]}, by eliminations {tally.ways[ELIMINATION]}, of {options.count}"
    )
    print(
        f"{tally.wrong} wrong rows, {tally.missed} missed, {tally.refused} refused by the verification"
    )
    print(f"seconds: median {np.median(tally.times):.2f}, max {max(tally.times):.2f}")
    for text, number in sorted(Counter(tally.unsolved).items()):
        print(f"not solved: {text} ({number})")
    if options.record:
        found = {
            "tables": options.count, "by_rules": tally.ways[RULES],
            "by_elimination": tally.ways[ELIMINATION], "wrong": tally.wrong, "missed": tally.missed,
            "median": round(float(np.median(tally.times)), 2),
            "by_joints": {n: [tally.solved[n], tally.total[n]] for n in sorted(tally.total)},
        }  # fmt: skip
        given = [x for x in (arguments or sys.argv[1:]) if x != "--record"]
        write_result(
            "random_chains", " ".join(["python -m benchmarks.random_chains", *given]), found
        )
    return int(tally.wrong + tally.missed + tally.refused > 0)


if __name__ == "__main__":
    raise SystemExit(main())
