"""Mutants of real robot files: whatever a file says, an answer or a refusal with its place, in time.

    python -m benchmarks.mutants [--read N] [--run N] [--first N] [--seed N] [--keep DIR] [--record [--add]]

N mutants are read in this process (file, chains, DH form, geometry), another N go through the command line
(`ikgen from-urdf`, Python and verification), from the one of number `--first` on. Wrong is: an exception
that is no `IkgenError` with a way out, an exit code other than 0, 2 or 3, a traceback, "please report it",
more than two minutes. Exit code 1 where any is.
"""

from __future__ import annotations

import argparse
import random
import shutil
import signal
import sys
import tempfile
import traceback
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from benchmarks import warm_runs
from benchmarks.collection import CORPUS
from benchmarks.command_line import FIXTURES
from benchmarks.mutations import mutant
from benchmarks.results import added_counts, write_result

__all__ = ["main", "read_one", "robot_files"]

SECONDS = 120
_READ_SECONDS = 20


def robot_files() -> list[Path]:
    """The files that are changed."""
    return [*sorted(FIXTURES.glob("*.urdf")), *sorted((CORPUS / "urdf").glob("*.urdf"))]


def mutants(count: int, seed: int, first: int = 0) -> Iterator[tuple[str, bytes]]:
    """Names and texts, each file in turn; of all mutants of the seed those from number `first` on."""
    files = robot_files()
    texts = {path: path.read_text("utf-8") for path in files}
    for number in range(first, first + count):
        path = files[number % len(files)]
        draw = random.Random(f"{seed}/{number}")
        text = mutant(texts[path], draw)
        yield f"{path.stem}_{seed}_{number}", text.encode("utf-8", "surrogateescape")


def read_one(path: Path) -> str:
    """How far reading in this process came, in a word; raises what is no refusal."""
    from ikgen.derivation.inspection import inspect_robot
    from ikgen.errors import IkgenError
    from ikgen.records.request import Request

    try:
        found = inspect_robot(Request(path), advice=False)
        if found.reading is None and found.candidates:
            chain = found.candidates[0]
            inspect_robot(Request(path, base=chain.base, tip=chain.tip), advice=False)
    except IkgenError as error:
        return "refused" if error.message and error.hint else "WRONG: refused without a way out"
    return "read"


def read_all(count: int, seed: int, keep: Path) -> Counter[str]:
    """The mutants of the first kind; wrong ones are kept."""

    def late(*_: object) -> None:
        raise TimeoutError

    signal.signal(signal.SIGALRM, late)
    counts = Counter[str]()
    path = keep / "mutant.urdf"
    for name, data in mutants(count, seed):
        path.write_bytes(data)
        signal.alarm(_READ_SECONDS)
        try:
            counts[read_one(path)] += 1
        except Exception as error:
            signal.alarm(0)
            words = f"WRONG: {type(error).__name__}"
            counts[words] += 1
            last = traceback.extract_tb(error.__traceback__)[-1]
            print(
                f"{name}: {words}: {error} ({Path(last.filename).name}:{last.lineno})", flush=True
            )
            (keep / f"{name}.urdf").write_bytes(data)
        finally:
            signal.alarm(0)
    path.unlink(missing_ok=True)
    return counts


def run_all(count: int, seed: int, keep: Path, first: int = 0) -> Counter[str]:
    """The mutants of the second kind."""
    counts = Counter[str]()
    if count:
        warm_runs.load("from-urdf", str(FIXTURES / "ur5e.urdf"), "-q", "--samples", "10")
    links = [arm_of(path) for path in robot_files()]
    for number, (name, data) in enumerate(mutants(count, seed + 1, first), start=first):
        path = keep / f"{name}.urdf"
        path.write_bytes(data)
        words = run_one(path, links[number % len(links)])
        counts[words] += 1
        if words.startswith("WRONG"):
            print(f"{name}: {words}", flush=True)
        else:
            path.unlink()
    return counts


def arm_of(path: Path) -> tuple[str, ...]:
    """Options that name an arm of a file as it was, where it has several."""
    from ikgen.derivation.inspection import inspect_robot
    from ikgen.records.request import Request

    found = inspect_robot(Request(path), advice=False)
    if found.reading is not None or not found.candidates:
        return ()
    return "--base", found.candidates[0].base, "--tip", found.candidates[0].tip


def run_one(path: Path, links: tuple[str, ...] = ()) -> str:
    """What the command line says to one file."""
    out = Path(tempfile.mkdtemp(prefix="mutants-"))
    try:
        command = ("from-urdf", str(path), *links, "-q", "--samples", "100", "-o", str(out / "out"))
        run = warm_runs.start(command, out, out / "said")
        code, said = run.wait(SECONDS), run.said
    finally:
        shutil.rmtree(out, ignore_errors=True)
    if code == warm_runs.LATE:
        return f"WRONG: more than {SECONDS} s"
    if code not in (0, 2, 3) or "Traceback" in said or "please report" in said:
        return f"WRONG: exit code {code}: {' '.join(said.split())[:300]}"
    return f"exit code {code}"


def main() -> int:
    """Count what came of the mutants."""
    parser = argparse.ArgumentParser(description="Mutants of real robot files.")
    parser.add_argument("--read", type=int, default=20000)
    parser.add_argument("--run", type=int, default=1000)
    parser.add_argument("--first", type=int, default=0, help="number of the first one that is run")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--keep", type=Path, default=None, help="where wrong ones are kept")
    parser.add_argument("--record", action="store_true", help="write the recorded result")
    parser.add_argument("--add", action="store_true", help="to what is recorded of this commit")
    options = parser.parse_args()
    keep = options.keep or Path(tempfile.mkdtemp(prefix="mutants-"))
    keep.mkdir(parents=True, exist_ok=True)
    found = {"read": read_all(options.read, options.seed, keep)}
    found["run"] = run_all(options.run, options.seed, keep, options.first)
    for kind, counts in found.items():
        for words, count in counts.most_common():
            print(f"{kind:5} {count:6}  {words}")
    wrong = sum(n for c in found.values() for words, n in c.items() if words.startswith("WRONG"))
    if options.record:
        result = {kind: dict(counts) for kind, counts in found.items()}
        if options.add:
            result = {kind: added_counts("mutants", kind, counts) for kind, counts in found.items()}
        write_result("mutants", "python -m benchmarks.mutants", result)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
