"""Many poses through the emitted C++ header or Python module of one arm: wrong rows, missed solutions.

    python -m benchmarks.soak [ARM ...] [--record] [--poses 10000000] [--near 1000000] [--above 1e-3]
        [--jobs 2] [--language cpp|python] [--option=--free --option=JOINT]

ARM is the name of an arm of the collection, or a URDF file or DH table (`--option` hands options to ikgen);
without any, ten of the collection: exact, rounded, off by small offsets, elimination, redundant.
Random poses, and poses 10^-1 to 10^-12 beside singular configurations, of which a quarter have joints at
multiples of 45 degrees and another one joint there and the others anywhere, joints inside their limits. Of
the latter poses half are solved without limits. A module takes thousands where a header takes millions (see
`benchmarks.module_soak`). Prints, by decade of the smallest singular value of the configuration that made
the pose: how many poses, at how many that configuration is missed among the rows, how many got no row at
all. How close a row must come is what `ikgen.verify.completeness` says. Exits with 1 if a row is wrong, or
anything is missed or unanswered at singular values from `--above` on. `--record` keeps what was found of
headers.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path

from benchmarks.command_line import Emitted, Source, emit, sources
from benchmarks.cpp_speed import FLAGS, compiled_program
from benchmarks.module_soak import soak_module
from benchmarks.results import write_result
from benchmarks.soak_counts import Soak, added, table

ARMS = (
    "kuka_kr6r900sixx", "staubli_tx60", "ur5e", "realman_rm65", "agilex_piper", "doosan_m1013",
    "fanuc_crx10ia", "xarm6", "kuka_iiwa7", "franka_fr3",
)  # fmt: skip
SOURCE = Path(__file__).resolve().parent / "cpp" / "soak.cpp"
ABOVE = 1e-3
"""As `FAILS_ABOVE` of `ikgen.verify.completeness`, by default."""
TASKS = {
    "pose": (1, 3), "position": (1, 0), "position-direction": (1, 1), "position-yaw": (1, 2),
    "position-pitch": (1, 4), "rotation": (0, 3), "direction": (0, 1),
}  # fmt: skip
"""Task -> whether it reads the position, and what of the rotation (see soak.cpp)."""


def parsed(text: str) -> Soak:
    """The output of one run of the program."""
    rows = wrong = 0
    decades, cases = [], []
    for line in text.splitlines():
        word, *rest = line.split()
        if word == "rows":
            rows, wrong = map(int, rest)
        elif word == "decade":
            decades.append(tuple(map(int, rest[1:])))
        else:
            cases.append(line)
    return Soak(rows, wrong, tuple(decades), tuple(cases))


def soak(
    made: Emitted,
    poses: int,
    near: int,
    *,
    jobs: int = 1,
    seed: int = 1,
    flags: Sequence[str] = tuple(FLAGS["native"]),
) -> Soak:
    """Compile the header and put the poses through it, shared among `jobs` processes."""
    with soak_program(made, flags) as program:
        return put_through(program, poses, near, jobs=jobs, seed=seed)


@contextmanager
def soak_program(made: Emitted, flags: Sequence[str]) -> Iterator[Path]:
    """The program that puts poses through a header, for as long as the context lasts."""
    assert made.header is not None
    task, _, axis = str(made.answer["task"]).partition(":")
    if task not in TASKS:
        raise SystemExit(f"soak knows no way to compare poses by {task}: {', '.join(TASKS)}")
    position, turn = TASKS[task]
    defines = [f"-DSOAK_POSITION={position}", f"-DSOAK_TURN={turn}"]
    defines.append(
        f"-DSOAK_AXIS={'xyz'.index(axis) if axis else 0 if task == 'position-yaw' else 2}"
    )
    with compiled_program(SOURCE, made.header, [*flags, *defines]) as program:
        yield program


def put_through(program: Path, poses: int, near: int, *, jobs: int = 1, seed: int = 1) -> Soak:
    """What the program says of the poses, shared among `jobs` processes."""

    def run(job: int) -> Soak:
        share = [str(-(-n // jobs)) for n in (poses, near)]
        command = [str(program), *share, str(seed + 1000 * job)]
        done = subprocess.run(command, check=True, capture_output=True, text=True)
        return parsed(done.stdout)

    with ThreadPoolExecutor(jobs) as pool:
        return added(list(pool.map(run, range(jobs))))


def found_source(name: str, options: Sequence[str]) -> Source:
    """The arm of a name or a file; raises `SystemExit` where there is none."""
    if Path(name).suffix in (".urdf", ".xacro", ".toml"):
        return Source(name, "", Path(name).resolve(), (), (tuple(options),))
    for source in sources():
        if source.key.split("/")[1] == name:
            return source
    raise SystemExit(f"no arm '{name}': give a URDF file, a DH table, or an arm of the collection")


def _through(made: Emitted, options: argparse.Namespace) -> Soak:
    if options.language == "cpp":
        return soak(made, options.poses, options.near, jobs=options.jobs, seed=options.seed)
    share = [-(-n // options.jobs) for n in (options.poses, options.near)]
    seeds = [options.seed + 1000 * job for job in range(options.jobs)]
    with ProcessPoolExecutor(options.jobs) as pool:
        runs = [pool.submit(soak_module, made, *share, seed=seed) for seed in seeds]
        return added([run.result() for run in runs])


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table; 1 where something failed."""
    layout = argparse.RawTextHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=layout)
    parser.add_argument("arms", nargs="*", default=ARMS)
    parser.add_argument(
        "--record", action="store_true", help="of headers: benchmarks/results/soak.json"
    )
    parser.add_argument("--poses", type=int, default=10_000_000)
    parser.add_argument("--near", type=int, default=1_000_000, help="poses beside singularities")
    parser.add_argument("--above", type=float, default=ABOVE)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--language", choices=("cpp", "python"), default="cpp")
    parser.add_argument("--option", action="append", default=[], help="handed to ikgen")
    options = parser.parse_args(arguments)
    if options.record and options.language != "cpp":
        parser.error("--record keeps what was found of headers: leave out --language python")
    results: dict[str, Soak] = {}
    for arm in options.arms:
        with tempfile.TemporaryDirectory(prefix="ikgen-soak-") as folder:
            made = emit(found_source(arm, options.option), Path(folder), "python,cpp")
            if made.module is None or made.header is None:
                message = made.answer.get("error", "")
                print(f"{arm}: ikgen ended with {made.code}: {message}", file=sys.stderr)
                return 2
            found = _through(made, options)
        results[arm] = found
        print(f"== {arm}")
        print("\n".join(table(found)), flush=True)
        if options.record:
            arms = {name: asdict(one) for name, one in results.items()}
            write_result(
                "soak", "python -m benchmarks.soak", {"above": options.above, "arms": arms}
            )
    return int(any(found.failures(options.above) for found in results.values()))


if __name__ == "__main__":
    sys.exit(main())
