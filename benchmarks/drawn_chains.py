"""One drawn chain: derived, its rows checked, and its solutions counted again by an independent search."""

from __future__ import annotations

import itertools
import os
import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType

import numpy as np

from benchmarks.command_line import load_module
from benchmarks.drawn import held_joints, revolute
from benchmarks.random_tables import pattern, table_text
from benchmarks.results import commit
from benchmarks.solution_search import Array, apart, searched
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

__all__ = ["ELIMINATION", "NEITHER", "RULES", "Extent", "Outcome", "outcome"]

RULES, ELIMINATION, NEITHER = "rules", "elimination", "nothing"
_count = itertools.count()


@dataclass(frozen=True, slots=True)
class Extent:
    """What is done with a table: through the command line, which verifies, or derived only; the outputs;
    random poses to check its rows at, and how many of them to search."""

    command_line: bool
    emit: str
    poses: int
    search: int


@dataclass(frozen=True, slots=True)
class Outcome:
    """What came of one table: `way`, how it was solved; `said`, the command line's own words; `refused`,
    by the verification; rows that are wrong and solutions that are missed, known and found ones; poses
    searched, and those of them where both found as many; seconds of processor time to derive and verify
    it."""

    chain: str
    joints: int
    way: str
    said: str
    refused: bool
    wrong: int
    missed: int
    searched: int
    equal: int
    seconds: float
    commit: str

    @property
    def good(self) -> bool:
        """Solved, right and complete."""
        left = self.wrong + self.missed + self.searched - self.equal
        return self.way != NEITHER and not self.refused and not left


def outcome(dh: DHChain, folder: Path, extent: Extent, seed: int) -> Outcome:
    """Derive, check and compare one table."""
    started, said = _processor_time(), ""
    if extent.command_line:
        way, path, said = _through_command_line(dh, folder, extent.emit)
    else:
        way, path = _derived(dh, folder)
    seconds = round(_processor_time() - started, 2)
    refused, counts = path is None and way != NEITHER, (0, 0, 0, 0)
    if path is not None and path.exists():
        counts = _counted(dh, load_module(path), extent, np.random.default_rng(seed))
    return Outcome(pattern(dh), dh.dof, way, said, refused, *counts, seconds, commit())


def _processor_time() -> float:
    """Of this process and those that it waited for (s): a busy machine changes little of it."""
    return sum(os.times()[:4])


def _derived(dh: DHChain, folder: Path) -> tuple[str, Path | None]:
    """How the chain was solved, and the emitted module's file."""
    facts = ("pose", (), "table", "0" * 64, "benchmark")
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


def _through_command_line(dh: DHChain, folder: Path, emit: str) -> tuple[str, Path | None, str]:
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


def _counted(
    dh: DHChain, module: ModuleType, extent: Extent, rng: np.random.Generator
) -> tuple[int, int, int, int]:
    """Wrong rows, missed solutions, poses searched, and those with as many solutions by search."""
    wrong, missed = _checked(dh, module, extent.poses, rng)
    if module.TASK != "pose" or not extent.search:
        return wrong, missed, 0, 0
    lost, *compared = _compared(dh, module, extent.search, rng)
    return wrong, missed + lost, compared[0], compared[1]


def _checked(
    dh: DHChain, module: ModuleType, poses: int, rng: np.random.Generator
) -> tuple[int, int]:
    """Wrong rows, by what the module's task reads, and missed configurations over random regular poses."""
    q = rng.uniform(-2.5, 2.5, (poses, dh.dof))
    regular = smallest_singular(dh, q, arm_size(dh)) > 1e-3
    task = find_task(module.TASK, getattr(module, "TOOL_AXIS", None))
    turning, space = revolute(module), task_space(task)
    held = held_joints(module)
    wrong = missed = 0
    for at, pose in zip(q[regular], dh_pose(dh, q[regular]), strict=True):
        rows = module.solve(pose, free=at[held] if held else None, limits=False).q
        back = module.forward(rows).reshape(-1, 4, 4)
        error = np.abs(space.residual(back, np.broadcast_to(pose, back.shape)))
        wrong += int((error.max(axis=-1, initial=0.0) > 1e-8).sum())
        missed += int(not len(rows) or apart(at, rows, turning).min() > 1e-6)
    return wrong, missed


def _regular(dh: DHChain, poses: int, rng: np.random.Generator) -> Array:
    """So many configurations well away from singularities; fewer where such are one in a hundred."""
    found = np.empty((0, dh.dof))
    for _ in range(25):
        q = rng.uniform(-2.0, 2.0, (4 * poses, dh.dof))
        regular = smallest_singular(dh, q, arm_size(dh)) > 1e-2
        found = np.concatenate([found, q[regular]])
        if len(found) >= poses:
            break
    return found[:poses]


def _compared(
    dh: DHChain, module: ModuleType, poses: int, rng: np.random.Generator
) -> tuple[int, int, int]:
    """Solutions of random regular poses that the search finds and the module does not, the poses, and those
    of them where their numbers are the same; the others are printed."""
    q = _regular(dh, poses, rng)
    turning, missed, equal = revolute(module), 0, 0
    for pose in dh_pose(dh, q):
        rows = module.solve(pose, limits=False).q
        found = searched(module, pose, rng, 3.0 * arm_size(dh), least=len(rows))
        lost = sum(not len(rows) or apart(x, rows, turning).min() > 1e-4 for x in found)
        missed, equal = missed + int(lost), equal + int(len(found) == len(rows) and not lost)
        if lost or len(found) != len(rows):
            counts = f"{len(rows)} solutions, {len(found)} by search, {lost} of them lost"
            print(f"{pattern(dh)}: {counts}", flush=True)
    return missed, len(q), equal
