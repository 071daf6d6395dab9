"""The C++ header against the Python module on every arm of the corpus: the same rows in the same order.

    python -m benchmarks.agreement [--family TEXT] [--arm NAME] [--poses 100000] [--eliminated 2000]

Both solve random poses, joints inside their limits, held joints at their defaults, limits disregarded.
Arms that need the general 6R elimination take milliseconds a pose in Python, so fewer of them
(--eliminated). Poses with a singular row are counted apart: which rows stand for a continuum hangs on the
last digits. Without the corpus the command says so.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.collection import ABSENT, CORPUS, load_arms, urdf_of
from ikgen.derivation.derive import derive
from ikgen.emit.derivation import Derivation
from ikgen.errors import IkgenError
from ikgen.generation.emitted_arm import EmittedArm
from ikgen.generation.emitted_checks import oracle_for
from ikgen.generation.emitters import find_emitter
from ikgen.records.request import Request
from ikgen.tasks import find_task
from ikgen.verify.agreement import disagreements
from ikgen.verify.arm import ArmUnderTest, arm_under_test
from ikgen.verify.runners.runner import Rows, Runner
from ikgen.verify.task_space import task_space

CHUNK = 20000


@dataclass(frozen=True, slots=True)
class Outcome:
    """What came of one arm; `largest` is the largest difference of rows (rad or m)."""

    name: str
    poses: int = 0
    compared: int = 0
    different: int = 0
    largest: float = 0.0
    note: str = ""


def derivation_of(arm: dict[str, Any], folder: Path) -> Derivation:
    """The arm's derivation, without options."""
    path = CORPUS / arm["file"] if arm.get("file") else folder / f"{arm['name']}.urdf"
    if not arm.get("file"):
        path.write_text(urdf_of(arm))
    return derive(Request(path, base=arm["base_link"], tip=arm["tip_link"], name="arm"))


def compare(arm: dict[str, Any], poses: int, eliminated: int) -> Outcome:
    """Emit both, solve, compare."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        try:
            derivation = derivation_of(arm, folder)
            runners = [runner_of(derivation, language, folder) for language in ("python", "cpp")]
        except IkgenError as error:
            return Outcome(arm["name"], note=error.message[:80])
        module = derivation.module
        count = eliminated if module.plan is not None else poses
        return _compare(arm["name"], derivation, runners, count)


def runner_of(derivation: Derivation, language: str, folder: Path) -> Runner:
    """One language's code, written and ready to run."""
    emitter = find_emitter(language)
    for file, text in emitter.emit(derivation).items():
        (folder / file).write_text(text, encoding="utf-8")
    runner: Runner | None = emitter.runner(EmittedArm.of(derivation.module), folder)
    assert runner is not None
    return runner


def arm_of(derivation: Derivation) -> ArmUnderTest:
    """The arm of a derivation, with its oracle."""
    dh, module = derivation.reading.dh, derivation.module
    limits = [(j.limits.lower, j.limits.upper) for j in dh.joints]
    lower, upper = (np.array(x) for x in zip(*limits, strict=True))
    held = tuple(dh.joints[j].name for j in module.free_indices)
    oracle = oracle_for(derivation.reading)
    return arm_under_test(oracle, task_space(find_task(module.task)), (lower, upper), held)


def _compare(name: str, derivation: Derivation, runners: Sequence[Runner], poses: int) -> Outcome:
    arm = arm_of(derivation)
    rng = np.random.default_rng(100)
    q = arm.uniform(rng, poses)
    q[:, list(arm.free)] = derivation.module.free_defaults
    compared = different = 0
    largest = 0.0
    for start in range(0, poses, CHUNK):
        T = arm.oracle.forward(q[start : start + CHUNK])
        ours, theirs = (_batch(runner, T) for runner in runners)
        wrong, counted, gap = disagreements(arm, ours, theirs)
        compared += int(counted.sum())
        different += int(wrong.sum())
        largest = max(largest, gap)
    return Outcome(name, poses, compared, different, largest)


def _batch(runner: Runner, T: np.ndarray) -> Rows:
    rows = runner.solve_batch(T, limits=False)
    assert rows is not None
    return rows


def main(arguments: Sequence[str] | None = None) -> int:
    """Print a row an arm; 1 if any differ."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--family", default="")
    parser.add_argument("--arm", action="append", default=[])
    parser.add_argument("--poses", type=int, default=100_000)
    parser.add_argument("--eliminated", type=int, default=2000)
    parser.add_argument("--jobs", type=int, default=2)
    options = parser.parse_args(arguments)
    arms = load_arms()
    if not arms:
        print(ABSENT)
        return 0
    wanted = [
        a
        for a in arms
        if options.family.lower() in a["family"].lower()
        and (not options.arm or a["name"] in options.arm)
    ]
    total = different = 0
    with ProcessPoolExecutor(options.jobs) as pool:
        sizes = [[x] * len(wanted) for x in (options.poses, options.eliminated)]
        for o in pool.map(compare, wanted, *sizes):
            total += o.compared
            different += o.different
            words = o.note or f"{o.compared:7} of {o.poses:7} poses, largest {o.largest:.1e}"
            print(f"{o.name:30} {o.different:5} different   {words}", flush=True)
    print(f"{total} poses compared, {different} answered differently")
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
