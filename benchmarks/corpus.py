"""Generate and verify every arm of the corpus; print a table by class.

    python -m benchmarks.corpus [--family TEXT] [--arm NAME] [--emit python,cpp] [--samples N] [--jobs N]
        [--executor process|dask] [--record] [--public]

The corpus is not part of the package (see benchmarks/README.md). Without it, or with --public, the arms are
those of files that anybody has: `urdf_fixtures/`, and example-robot-data where it is installed. Each is
solved if both languages pass their verification. Seconds are those that a user waits, one arm at a time
unless --jobs asks for more, and those of processor time, the compiler's with it; ikgen's modules are
compiled to bytecode before, as pip does. --record writes results/corpus.json or results/public.json.
"""

from __future__ import annotations

import argparse
import compileall
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import ikgen
from benchmarks.collection import CORPUS, load_arms, urdf_of
from benchmarks.public_arms import public_arms
from benchmarks.results import write_result
from ikgen.importers.named_robots import is_named
from ikgen.processes.executors import EXECUTORS, Workers

WIDTHS = (4, 6, 8, 6, 8, 6, 11, 6)


@dataclass(frozen=True, slots=True)
class Outcome:
    """What came of one arm; `waited` and `processor` in seconds."""

    name: str
    family: str
    task: str
    state: str
    waited: float
    processor: float
    solutions: str
    closure: str
    message: str


def run_arm(arm: dict[str, Any], samples: int, languages: str) -> Outcome:
    """Run the command line on one arm in a folder of its own."""
    with tempfile.TemporaryDirectory() as folder:
        robot = _robot(arm, Path(folder))
        command = [
            sys.executable, "-m", "ikgen", "from-urdf", robot, "--json", "-q",
            "--base", arm["base_link"], "--tip", arm["tip_link"], "-o", folder,
            "--samples", str(samples), "--emit", languages,
        ]  # fmt: skip
        code, out, err, *seconds = _run(command, Path(folder))
        return _outcome(arm, {**_parse(out, err), "code": code}, *seconds)


def _run(command: Sequence[str], folder: Path) -> tuple[int, str, str, float, float]:
    """Exit code, stdout, stderr, seconds waited, and those of processor time: a busy machine changes these
    little."""
    places = folder / "stdout.txt", folder / "stderr.txt"
    begin = time.perf_counter()
    with places[0].open("w") as out, places[1].open("w") as err:
        process = subprocess.Popen(command, stdout=out, stderr=err)
        _, status, usage = os.wait4(process.pid, 0)
    waited = time.perf_counter() - begin
    process.returncode = os.waitstatus_to_exitcode(status)
    texts = [place.read_text(encoding="utf-8") for place in places]
    return process.returncode, texts[0], texts[1], waited, usage.ru_utime + usage.ru_stime


def _robot(arm: dict[str, Any], folder: Path) -> str:
    """What to type for the arm's robot: a name, its file, or one that is written now."""
    file = arm.get("file")
    if file:
        return file if is_named(file) else str(CORPUS / file)
    path = folder / f"{arm['name']}.urdf"
    path.write_text(urdf_of(arm))
    return str(path)


def _parse(out: str, err: str) -> dict[str, Any]:
    try:
        parsed: dict[str, Any] = json.loads(out)
    except json.JSONDecodeError:
        lines = err.strip().splitlines()
        parsed = {"error": lines[-1] if lines else ""}
        if len(lines) > 1:
            parsed["error"] = " ".join(lines)
    return parsed


def _outcome(
    arm: dict[str, Any], result: dict[str, Any], waited: float, processor: float
) -> Outcome:
    state = {0: "solved", 1: "WRONG", 2: "ERROR", 3: "unsolved"}.get(result["code"], "CRASH")
    report = next(iter((result.get("verification") or {}).values()), {})
    counts = report.get("solutions") or {}
    text = f"{counts['min']}..{counts['max']}" if counts else ""
    closure = next((c for c in report.get("checks", []) if c["name"] == "closure"), {})
    worst = closure.get("worst") or {}
    numbers = " ".join(f"{v:.0e}" for v in worst.values() if v is not None)
    held = (result.get("chosen") or {}).get("held") or ()
    message = str(result.get("error") or " ".join(["holding", *held] if held else []))
    task = str(result.get("task") or "")
    seconds = waited, processor
    return Outcome(arm["name"], arm["family"], task, state, *seconds, text, numbers, message[:300])


def _table(classes: Sequence[dict[str, Any]]) -> Iterator[str]:
    head = ("arms", "solved", "unsolved", "failed", "median s", "max s", "processor s", "max s")
    yield f"{'class':58} " + " ".join(f"{h:>{w}}" for h, w in zip(head, WIDTHS, strict=True))
    for c in classes:
        counts = c["arms"], c["solved"], c["unsolved"], c["failed"]
        times = (f"{x:.1f}" for x in (*c["waited"], *c["processor"]))
        cells = (f"{x:>{w}}" for x, w in zip((*counts, *times), WIDTHS, strict=True))
        yield f"{c['family']:58} " + " ".join(cells)


def _by_class(outcomes: Sequence[Outcome]) -> list[dict[str, Any]]:
    """Counts of each class and of all, and [median, longest] of the seconds of those that were solved."""
    families = sorted({o.family for o in outcomes})
    return [_counted(f, [o for o in outcomes if o.family == f]) for f in families] + [
        _counted("all", outcomes)
    ]


def _counted(family: str, outcomes: Sequence[Outcome]) -> dict[str, Any]:
    solved = [o for o in outcomes if o.state == "solved"]
    unsolved = sum(o.state == "unsolved" for o in outcomes)
    failed = len(outcomes) - len(solved) - unsolved
    counts = {"arms": len(outcomes), "solved": len(solved), "unsolved": unsolved, "failed": failed}
    seconds = {"waited": [o.waited for o in solved], "processor": [o.processor for o in solved]}
    times = {
        kind: [round(of(some or [0.0]), 2) for of in (statistics.median, max)]
        for kind, some in seconds.items()
    }
    return {"family": family, **counts, **times}


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the corpus; 1 if an arm that was solved is wrong, 0 otherwise."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--family", default="", help="only classes whose name contains this")
    parser.add_argument("--arm", action="append", default=[], help="only this arm (repeatable)")
    parser.add_argument("--emit", default="python,cpp", help="languages")
    parser.add_argument("--samples", type=int, default=1000)
    parser.add_argument("--jobs", type=int, default=1, help="arms at a time")
    parser.add_argument("--executor", choices=EXECUTORS, default="process")
    parser.add_argument("--scheduler", help="the Dask scheduler that runs already")
    parser.add_argument("--json", type=Path, help="write the outcomes here")
    parser.add_argument("--public", action="store_true", help="arms that anybody has")
    parser.add_argument("--record", action="store_true", help="write results/")
    options = parser.parse_args(arguments)
    if options.record and (options.family or options.arm or options.jobs > 1):
        parser.error("--record is for the whole collection, one arm at a time")
    compileall.compile_dir(Path(ikgen.__file__).parent, quiet=1)
    collection = [] if options.public else load_arms()
    arms = collection or public_arms()
    arms = [a for a in arms if options.family in a["family"]]
    arms = [a for a in arms if not options.arm or a["name"] in options.arm]
    workers = Workers(options.executor, options.jobs, options.scheduler)
    with workers.open() as pool:
        outcomes = []
        asked = [options.samples] * len(arms), [options.emit] * len(arms)
        for o in pool.map(run_arm, arms, *asked):
            outcomes.append(o)
            print(
                f"{o.name:30} {o.state:9} {o.waited:6.1f} s  {o.task:18} {o.solutions:6} "
                f"{o.closure:12} {o.message}",
                flush=True,
            )
    print()
    classes = _by_class(outcomes)
    for line in _table(classes):
        print(line)
    if options.json:
        options.json.write_text(json.dumps([asdict(o) for o in outcomes], indent=1))
    if options.record:
        name, extra = ("corpus", "") if collection else ("public", " --public")
        left = [o.name for o in outcomes if o.state != "solved"]
        found = {"samples": options.samples, "classes": classes, "left": left}
        write_result(name, f"python -m benchmarks.corpus{extra}", found)
    return int(any(o.state in ("WRONG", "CRASH", "ERROR") for o in outcomes))


if __name__ == "__main__":
    raise SystemExit(main())
