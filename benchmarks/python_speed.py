"""Microseconds a pose of emitted Python modules, scalar, batch and compiled, beside an exact arm.

    python -m benchmarks.python_speed [ARM ...] [--poses 10000] [--no-compiled]

ARM is the name of an arm of the collection, or a URDF file or DH table; without any, some of each class.
All is timed at random poses that the arm reaches, with default arguments: `solve` ("scalar"), `solve_batch`
of all poses ("batch"), `solve` of the compiled package ("nanobind") and of the header compiled with the
same flags ("C++"). "careful" is how many of a thousand poses `solve` and `solve_batch` take beyond the
closed form and its refinement, as they may be near singularities. Times are of the processor, the best of
some rounds; "exact" is what `kuka_kr6r900sixx` took in the same rounds. A mark (*) is at times above the
goal of the arm's kind, and at nanobind's above 1.2 times C++ and 1.5 us. The compiled package needs pip, a
compiler and network access for its build tools.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.command_line import Emitted, emit, load_module
from benchmarks.cpp_speed import FLAGS, compiled_program
from benchmarks.peer_arms import compiled
from benchmarks.peer_solvers import AbsentError
from benchmarks.soak import found_source

__all__ = ["GOALS", "Timed", "kind_of", "main", "table", "timed_module"]

ARMS = (
    "kuka_kr6r900sixx", "ur5e", "elite_ec66", "mycobot_pro630", "doosan_m1013", "agilex_piper",
    "realman_rm65", "kuka_iiwa7", "realman_rm75", "so100", "so101", "fanuc_crx10ia", "kinova_j2n6s300",
    "niryo_ned2", "denso_cobotta", "baxter_left",
)  # fmt: skip
EXACT = "kuka_kr6r900sixx"
GOALS = {"exact": (55.0, 2.0), "rounded": (150.0, 6.0), "elimination": (1200.0, 120.0)}
"""Kind of an arm -> us a pose of `solve` and of `solve_batch`."""
FEW = 300
"""Poses of which `solve` takes one after the other."""
ROUNDS = 5
ENOUGH = 5.0
"""Seconds after which there are no more rounds."""

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Timed:
    """One arm: us a pose of `solve` and `solve_batch`, the same of the exact arm, and how many of a
    thousand poses each of them takes care of; us of `solve` compiled, with Python around it and without,
    or None."""

    name: str
    kind: str
    scalar: float
    batch: float
    exact: tuple[float, float]
    careful: tuple[float, float]
    native: float | None = None
    cpp: float | None = None


def reachable(module: ModuleType, count: int) -> Array:
    """Poses (count, 4, 4) of random joint values inside the limits, held joints at their defaults."""
    low, high = np.maximum(module.LOWER, -3.1), np.minimum(module.UPPER, 3.1)
    q = np.random.default_rng(7).uniform(low, high, (count, module.DOF))
    q[:, list(module._ARM.free)] = module._ARM.free_defaults[: len(module._ARM.free)]
    return np.asarray(module.forward(q))


def kind_of(module: ModuleType) -> str:
    """A key of `GOALS`."""
    if module._ARM.branches is None:
        return "elimination"
    return "rounded" if module._ARM.together is not None else "exact"


def best_of(*runs: Callable[[], Any]) -> list[float]:
    """Least seconds of the processor of each, in turns."""
    least, begun = [float("inf")] * len(runs), time.process_time()
    for _ in range(ROUNDS):
        for k, run in enumerate(runs):
            start = time.process_time()
            run()
            least[k] = min(least[k], time.process_time() - start)
        if time.process_time() - begun > ENOUGH:
            break
    return least


@contextmanager
def counted(module: ModuleType) -> Iterator[list[int]]:
    """The numbers of poses that the module's careful path is given meanwhile."""
    counts: list[int] = []
    careful = module._placed_rows

    def counting(arm: Any, asked: Any, limits: bool) -> Any:
        counts.append(len(asked.T))
        return careful(arm, asked, limits)

    module._placed_rows = counting  # type: ignore[attr-defined]
    try:
        yield counts
    finally:
        module._placed_rows = careful  # type: ignore[attr-defined]


def each(solve: Callable[[Array], Any], poses: Array) -> Callable[[], None]:
    """A run of all poses, one after the other."""

    def run() -> None:
        for pose in poses:
            solve(pose)

    return run


def timed_module(name: str, module: ModuleType, exact: ModuleType, count: int) -> Timed:
    """The Python module's times."""
    many, others = reachable(module, count), reachable(exact, count)
    few = many[:FEW]
    careful = []
    for run, poses in ((each(module.solve, few), few), (lambda: module.solve_batch(many), many)):
        with counted(module) as counts:
            run()
        careful.append(1000.0 * sum(counts) / len(poses))
    seconds = best_of(each(module.solve, few), each(exact.solve, others[:FEW]))
    batches = best_of(lambda: module.solve_batch(many), lambda: exact.solve_batch(others))
    scalar, beside = (1e6 * x / len(few) for x in seconds)
    batch, beside_batch = (1e6 * x / count for x in batches)
    return Timed(
        name, kind_of(module), scalar, batch, (beside, beside_batch), (careful[0], careful[1])
    )


def timed_package(made: Emitted, poses: Array) -> tuple[float, float]:
    """us of the compiled package's `solve`, and of the header's. Raises AbsentError without build tools."""
    assert made.header is not None
    folder = made.header.parent
    package = compiled(f"{made.header.stem}_ext", folder)
    file = folder / "poses"
    file.write_bytes(np.ascontiguousarray(poses).tobytes())
    source = Path(__file__).parent / "cpp" / "given_poses.cpp"
    with compiled_program(source, made.header, FLAGS["plain"]) as program:
        done = subprocess.run([program, file], check=True, capture_output=True, text=True)
    (native,) = best_of(each(package.solve, poses))
    return 1e6 * native / len(poses), float(done.stdout) / 1e3


def table(timed: Sequence[Timed]) -> Iterator[str]:
    """A line an arm."""
    yield (
        f"{'arm':24} {'kind':12} {'scalar':>9} {'exact':>7} {'batch':>9} {'exact':>7} "
        f"{'careful, of 1000':>17} {'nanobind':>9} {'C++':>8}"
    )
    for t in timed:
        most, most_batch = GOALS[t.kind]
        native, cpp = "", ""
        if t.native is not None and t.cpp is not None:
            native, cpp = _marked(t.native, 1.2 * t.cpp + 1.5, 2), f"{t.cpp:.2f}"
        yield (
            f"{t.name:24} {t.kind:12} {_marked(t.scalar, most, 0):>9} {t.exact[0]:7.0f} "
            f"{_marked(t.batch, most_batch, 1):>9} {t.exact[1]:7.1f} "
            f"{t.careful[0]:8.1f} {t.careful[1]:8.1f} {native:>9} {cpp:>8}"
        )


def _marked(value: float, goal: float, digits: int) -> str:
    return f"{value:.{digits}f}{'*' if value > goal else ' '}"


def time_arm(name: str, exact: ModuleType, count: int, package: bool) -> Timed | str:
    """The arm's times, or why there are none."""
    stem = Path(name).stem.replace("-", "_")
    languages = "python,cpp,nanobind" if package else "python"
    with tempfile.TemporaryDirectory(prefix="ikgen-speed-") as folder:
        made = emit(found_source(name, ()), Path(folder), languages, stem)
        if made.module is None:
            return f"{name}: exit code {made.code}"
        module = load_module(made.module)
        found = timed_module(name, module, exact, count)
        if not package:
            return found
        try:
            native, cpp = timed_package(made, reachable(module, count)[: 10 * FEW])
        except AbsentError as reason:
            print(f"{name}: no compiled package, {reason}", file=sys.stderr)
            return found
    return Timed(
        name, found.kind, found.scalar, found.batch, found.exact, found.careful, native, cpp
    )


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table, a line at a time."""
    layout = argparse.RawTextHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=layout)
    parser.add_argument("arms", nargs="*", default=ARMS)
    parser.add_argument("--poses", type=int, default=10_000)
    parser.add_argument("--no-compiled", action="store_true", help="the Python modules alone")
    options = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory(prefix="ikgen-speed-") as folder:
        made = emit(found_source(EXACT, ()), Path(folder), "python")
        assert made.module is not None
        exact = load_module(made.module)
    head, *_ = table(())
    print(head)
    for name in options.arms:
        found = time_arm(name, exact, options.poses, not options.no_compiled)
        print(found if isinstance(found, str) else list(table([found]))[1], flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
