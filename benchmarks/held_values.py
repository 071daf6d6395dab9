"""self_motion and search of C++ headers with held joints: against grids and random values, and timed.

    python -m benchmarks.held_values [--arm NAME] [--poses 20] [--values 10000] [--joints 7]
        [--flags native] [--arm-angle] [--log FILE] [--done] [--record]

Takes every arm of the collection with so many joints that move or more, or ROBOT files by `--arm FILE`. For
each, random poses inside the limits. Intervals of self_motion are compared with the rows of solve on a grid
of the held joint's values, step 1e-3, and 1e-6 to both sides of each end: "missed" counts runs of two grid
values and more at which they differ, "off" ends that are elsewhere. The best row of search, by each of its
three preferences, is compared with the best at random values of the held joints: "worse" counts searches
that were beaten. Times are the median and the largest over the poses, processor time in us, of the best
of several runs. With --arm-angle the arms that have one hold that in place of a joint. What is done stands
in FILE of --log, one JSON object a line, and a run with the same file goes on behind it; --done sums up
what stands there. Exits with 1 if anything is missed, off or worse.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from statistics import median

from benchmarks.command_line import Source, emit, sources
from benchmarks.cpp_speed import FLAGS, compiled_program
from benchmarks.results import commit, write_result

SOURCE = Path(__file__).resolve().parent / "cpp" / "held.cpp"


@dataclass(frozen=True, slots=True)
class Held:
    """What was found for one arm: `times`, median and largest us of self_motion and of search by each
    preference; counts as above; what failed, a line each; which closed form it has, and the commit."""

    times: tuple[float, ...]
    intervals: int
    missed: int
    off: int
    searches: int
    worse: int
    cases: tuple[str, ...]
    form: str = ""
    commit: str = ""

    @property
    def failures(self) -> int:
        """Of all kinds."""
        return self.missed + self.off + self.worse


def parsed(text: str) -> Held:
    """The output of one run of the program."""
    times, intervals, searches, *cases = text.splitlines()
    found, missed, off = map(int, intervals.split())
    searched, worse = map(int, searches.split())
    numbers = tuple(map(float, times.split()))
    return Held(numbers, found, missed, off, searched, worse, tuple(cases))


def measure(
    header: Path, held: Sequence[str], arguments: Sequence[int], flags: Sequence[str]
) -> Held:
    """Compile the header and run the program with poses, random values a pose, and seed."""
    angle = int("arm_angle" in held)
    flags = [*flags, f"-DHELD={int(len(held) == 1)}", f"-DARM_ANGLE={angle}"]
    with compiled_program(SOURCE, header, flags) as program:
        command = [str(program), *map(str, arguments)]
        return parsed(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def chosen(arms: Sequence[str], joints: int) -> list[Source]:
    """The arms of these names or files, or those of the collection with so many joints."""
    files = [Path(arm) for arm in arms if Path(arm).suffix in (".urdf", ".xacro", ".toml")]
    if files:
        return [Source(f"file/{file.stem}", "", file.resolve()) for file in files]
    found = [s for s in sources(("corpus",)) if _moving(s) >= joints]
    return [s for s in found if not arms or s.key.split("/")[1] in arms]


def _moving(source: Source) -> int:
    return sum(j["type"] not in ("fixed", "mimic") for j in source.row["chain"])


def form_of(answer: dict[str, object]) -> str:
    """Which closed form the command line said that an arm has."""
    return "elimination" if "elimination" in str(answer.get("chosen")) else "rules"


def figures(found: Sequence[Held]) -> list[dict[str, object]]:
    """What is recorded: by closed form, the counts and the median and largest times (us) of self_motion and
    of the slowest search. Times of self_motion are of the arms that have it."""
    rows = []
    for form in ("rules", "elimination"):
        some = [one for one in found if one.form == form]
        if not some:
            continue
        motions = [one.times[:2] for one in some if one.intervals] or [(0.0, 0.0)]
        rows.append({
            "form": form, "arms": len(some),
            **{key: sum(getattr(one, key) for one in some)
               for key in ("intervals", "missed", "off", "searches", "worse")},
            "motion": median(m[0] for m in motions), "motion_most": max(m[1] for m in motions),
            "search": median(max(one.times[2::2]) for one in some),
            "search_most": max(max(one.times[3::2]) for one in some),
        })  # fmt: skip
    return rows


def line(name: str, form: str, held: Held) -> str:
    """What is printed of an arm."""
    times = " ".join(f"{x:9.1f}" for x in held.times)
    return (
        f"{name:30} {form:12} {times} {held.intervals:6} {held.missed:7} {held.off:4} "
        f"{held.searches:6} {held.worse:6}"
    )


def logged(path: Path | None) -> dict[str, Held]:
    """What stands in the file, by the arm's key."""
    text = path.read_text(encoding="utf-8") if path is not None and path.is_file() else ""
    rows = [json.loads(row) for row in text.splitlines()]
    return {
        key: Held(**{**row, **{name: tuple(row[name]) for name in ("times", "cases")}})
        for key, row in rows
    }


def main(arguments: Sequence[str] | None = None) -> int:
    """Print a line an arm; 1 where something failed."""
    layout = argparse.RawTextHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=layout)
    parser.add_argument("--arm", action="append", default=[], help="name or file (repeatable)")
    parser.add_argument("--joints", type=int, default=7)
    parser.add_argument("--poses", type=int, default=20)
    parser.add_argument("--values", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--flags", choices=FLAGS, default="native")
    parser.add_argument("--arm-angle", action="store_true")
    parser.add_argument("--log", type=Path, help="file of what is done, to go on from")
    parser.add_argument("--done", action="store_true", help="nothing but what stands in the log")
    parser.add_argument("--record", action="store_true", help="write results/held_values.json")
    options = parser.parse_args(arguments)
    found = chosen(options.arm, options.joints)
    if not found:
        parser.error(
            "no such arm: give a URDF file, or see benchmarks/README.md for the collection"
        )
    heads = ("motion", "most", "near", "most", "centre", "most", "dexterous", "most")
    times = " ".join(f"{head:>9}" for head in heads)
    print(f"{'arm':30} {'closed form':12} {times}  found  missed  off  tried  worse")
    numbers = (options.poses, options.values, options.seed)
    done = logged(options.log)
    for source in found:
        if options.done or source.key in done:
            continue
        if options.arm_angle:
            source = replace(source, choices=(("--free", "arm-angle"),))
        with tempfile.TemporaryDirectory(prefix="ikgen-held-") as folder:
            made = emit(source, Path(folder), "cpp")
            name = source.key.split("/")[1]
            joints = made.answer.get("free") or ()
            if made.header is None or not joints:
                print(f"{name:30} {made.answer.get('error', 'holds no joint')}", flush=True)
                continue
            measured = measure(made.header, joints, numbers, FLAGS[options.flags])
        held = replace(measured, form=form_of(made.answer), commit=commit())
        done[source.key] = held
        if options.log:
            with options.log.open("a", encoding="utf-8") as log:
                log.write(json.dumps([source.key, asdict(held)]) + "\n")
        print(line(name, held.form, held), flush=True)
        for case in held.cases[:5]:
            print("   ", case)
    mine = [done[source.key] for source in found if source.key in done]
    if options.record:
        write_result("held_values", "python -m benchmarks.held_values", {"forms": figures(mine)})
    return int(any(held.failures for held in mine))


if __name__ == "__main__":
    sys.exit(main())
