"""Millions of poses through the emitted C++ header of one arm: wrong rows, missed solutions.

    python -m benchmarks.soak [ARM ...] [--record] [--poses 10000000] [--near 1000000] [--above 1e-3]
        [--jobs 2] [--option=--free --option=JOINT]

ARM is the name of an arm of the collection, or a URDF file or DH table (`--option` hands options to ikgen);
without any, ten of the collection: exact, rounded, off by small offsets, elimination, redundant.
Random poses, and poses 10^-1 to 10^-12 beside singular configurations, joints inside their limits. Prints,
by decade of the smallest singular value of the configuration that made the pose: how many poses, at how
many that configuration is missed among the rows, how many got no row at all. How close a row must come is
what `ikgen.verify.completeness` says. Exits with 1 if a row is wrong, or anything is missed or unanswered
at singular values from `--above` on.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path

from benchmarks.command_line import Emitted, Source, emit, sources
from benchmarks.cpp_speed import FLAGS, compiled_program
from benchmarks.results import write_result

ARMS = (
    "kuka_kr6r900sixx", "staubli_tx60", "ur5e", "realman_rm65", "agilex_piper", "doosan_m1013",
    "fanuc_crx10ia", "xarm6", "kuka_iiwa7", "franka_fr3",
)  # fmt: skip
SOURCE = Path(__file__).resolve().parent / "cpp" / "soak.cpp"
ABOVE = 1e-3
"""As `FAILS_ABOVE` of `ikgen.verify.completeness`, by default."""
TASKS = {
    "pose": (1, 3), "position": (1, 0), "position-direction": (1, 1), "position-yaw": (1, 2),
    "rotation": (0, 3), "direction": (0, 1),
}  # fmt: skip
"""Task -> whether it reads the position, and what of the rotation (see soak.cpp)."""


@dataclass(frozen=True, slots=True)
class Soak:
    """What was found. `decades`: per power of ten of the smallest singular value, poses, missed and
    unanswered of the random poses and the same of those beside singularities; `cases` spells out
    failures."""

    rows: int
    wrong: int
    decades: tuple[tuple[int, ...], ...]
    cases: tuple[str, ...]

    def failures(self, above: float) -> int:
        """Wrong rows, and misses and unanswered poses at singular values from `above` on."""
        kept = [d for k, d in enumerate(self.decades) if 10.0 ** -(k + 1) >= above * (1 - 1e-9)]
        return self.wrong + sum(d[i] for d in kept for i in (1, 2, 4, 5))


def added(parts: Sequence[Soak]) -> Soak:
    """The sum of several runs."""
    decades = zip(*(p.decades for p in parts), strict=True)
    return Soak(
        sum(p.rows for p in parts),
        sum(p.wrong for p in parts),
        tuple(tuple(map(sum, zip(*d, strict=True))) for d in decades),
        tuple(case for p in parts for case in p.cases),
    )


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
    assert made.header is not None
    task = str(made.answer["task"])
    if task not in TASKS:
        raise SystemExit(f"soak knows no way to compare poses by {task}: {', '.join(TASKS)}")
    position, turn = TASKS[task]
    defines = [f"-DSOAK_POSITION={position}", f"-DSOAK_TURN={turn}"]
    with compiled_program(SOURCE, made.header, [*flags, *defines]) as program:

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


def table(found: Soak) -> Iterator[str]:
    """The lines to print."""
    yield f"{'smallest singular value':26} {'random':>10} {'missed':>7} {'no row':>7}  " + (
        f"{'beside':>9} {'missed':>7} {'no row':>7}"
    )
    for k, d in enumerate(found.decades):
        if d[0] or d[3]:
            span = f"1e-{k:02} to 1e-{k + 1:02}" if k else "0.1 and more"
            last = f"below 1e-{k:02}" if k == len(found.decades) - 1 else span
            yield f"{last:26} {d[0]:10} {d[1]:7} {d[2]:7}  {d[3]:9} {d[4]:7} {d[5]:7}"
    yield f"{found.rows} rows, {found.wrong} wrong"
    yield from found.cases


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table; 1 where something failed."""
    layout = argparse.RawTextHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=layout)
    parser.add_argument("arms", nargs="*", default=ARMS)
    parser.add_argument("--record", action="store_true", help="write benchmarks/results/soak.json")
    parser.add_argument("--poses", type=int, default=10_000_000)
    parser.add_argument("--near", type=int, default=1_000_000, help="poses beside singularities")
    parser.add_argument("--above", type=float, default=ABOVE)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--option", action="append", default=[], help="handed to ikgen")
    options = parser.parse_args(arguments)
    results: dict[str, Soak] = {}
    for arm in options.arms:
        with tempfile.TemporaryDirectory(prefix="ikgen-soak-") as folder:
            made = emit(found_source(arm, options.option), Path(folder), "python,cpp")
            if made.header is None:
                message = made.answer.get("error", "")
                print(f"{arm}: ikgen ended with {made.code}: {message}", file=sys.stderr)
                return 2
            found = soak(made, options.poses, options.near, jobs=options.jobs, seed=options.seed)
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
