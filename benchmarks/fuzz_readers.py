"""atheris on the readers: bytes become URDF files, xacro files, DH tables, calibrations and configs.

    python -m benchmarks.fuzz_readers [--runs N] [--seed N] [--only READER ...] [--record]

Coverage of ikgen's own importers guides the mutations, which begin at files that are there. Wrong is an
exception that is no `IkgenError` with a message and a way out, and an input that takes more than ten
seconds. Exit code 1 where anything is. Needs `pip install atheris`.
"""

from __future__ import annotations

import argparse
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from benchmarks.command_line import FIXTURES, REPOSITORY
from benchmarks.results import write_result

__all__ = ["READERS", "main"]


def _robot(path: Path) -> None:
    from ikgen.derivation.inspection import inspect_robot
    from ikgen.records.request import Request

    inspect_robot(Request(path), advice=False)


def _config(path: Path) -> None:
    from ikgen.projects.config import load_config

    load_config(path)


def _calibration(path: Path) -> None:
    from ikgen.derivation.inspection import inspect_robot
    from ikgen.records.request import Request

    inspect_robot(Request(FIXTURES / "ur5e.urdf", calibration=path), advice=False)


READERS: dict[str, tuple[str, Callable[[Path], None], tuple[str, ...]]] = {
    "urdf": ("urdf", _robot, ("urdf_fixtures/*.urdf", "examples/**/*.urdf")),
    "xacro": ("urdf.xacro", _robot, ("examples/**/*.xacro", "tests/**/*.xacro")),
    "table": ("toml", _robot, ("urdf_fixtures/*.toml", "tests/robots/tables/*.toml")),
    "calibration": ("yaml", _calibration, ()),
    "config": ("toml", _config, ("examples/**/ikgen.toml",)),
}
"""Reader -> suffix of its files, what reads one, where files are that fuzzing begins with."""

CALIBRATION = """kinematics:
  shoulder: {x: 0, y: 0, z: 0.16236, roll: 0, pitch: 0, yaw: 2.1e-05}
  upper_arm: {x: 0.00013, y: 0, z: 0, roll: 1.57138, pitch: 0, yaw: -3.4e-05}
  forearm: {x: -0.42487, y: 0, z: 0, roll: 0.00073, pitch: -0.00041, yaw: 1.2e-05}
"""


def target(suffix: str, read: Callable[[Path], None], folder: Path) -> Callable[[bytes], None]:
    """What atheris calls."""
    from ikgen.errors import IkgenError

    path = folder / f"fuzzed.{suffix}"

    def one(data: bytes) -> None:
        path.write_bytes(data)
        try:
            read(path)
        except IkgenError as error:
            if not (error.message and error.hint):
                raise RuntimeError("refused without a way out") from error

    return one


def run_here(name: str, arguments: list[str], folder: Path) -> None:
    """Fuzz one reader in this process, which ends with it."""
    import atheris

    suffix, read, _ = READERS[name]
    with atheris.instrument_imports(include=["ikgen.importers", "ikgen.projects", "ikgen.chains"]):
        import ikgen.importers
        import ikgen.projects.config  # noqa: F401
    atheris.Setup([sys.argv[0], *arguments], target(suffix, read, folder))
    atheris.Fuzz()


def fuzz(name: str, runs: int, seed: int) -> str:
    """What was found in one reader: "nothing", or the last words."""
    folder = Path(tempfile.mkdtemp(prefix="fuzz-"))
    try:
        corpus = folder / "corpus"
        corpus.mkdir()
        (corpus / "calibration").write_text(CALIBRATION, encoding="utf-8")
        for pattern in READERS[name][2]:
            for number, path in enumerate(sorted(REPOSITORY.glob(pattern))):
                if path.stat().st_size < 20_000:
                    shutil.copy(path, corpus / f"{number}_{path.name}")
        options = [
            f"-runs={runs}",
            f"-seed={seed}",
            "-timeout=10",
            "-max_len=20000",
            "-rss_limit_mb=4000",
        ]
        command = [
            sys.executable,
            "-m",
            "benchmarks.fuzz_readers",
            "--here",
            name,
            "--folder",
            str(folder),
        ]
        done = subprocess.run([*command, "--", *options, str(corpus)], capture_output=True)
        said = done.stderr.decode("utf-8", "replace") + done.stdout.decode("utf-8", "replace")
        if done.returncode == 0 and f"Done {runs} " in said:
            return "nothing"
        kept = Path.cwd() / f"fuzzed-{name}.{READERS[name][0]}"
        shutil.copy(folder / f"fuzzed.{READERS[name][0]}", kept)
        return f"{said[-600:]} (kept as {kept})"
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def main() -> int:
    """Fuzz each reader."""
    parser = argparse.ArgumentParser(description="atheris on the readers.")
    parser.add_argument("--runs", type=int, default=20_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", nargs="+", choices=READERS, default=list(READERS))
    parser.add_argument("--record", action="store_true", help="write the recorded result")
    parser.add_argument("--here", choices=READERS, help=argparse.SUPPRESS)
    parser.add_argument("--folder", type=Path, help=argparse.SUPPRESS)
    parser.add_argument("rest", nargs="*", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.here:
        run_here(options.here, options.rest, options.folder)
    found, started = {}, time.monotonic()
    for name in options.only:
        found[name] = fuzz(name, options.runs, options.seed)
        print(f"{name:12} {options.runs:,} runs: {found[name]}", flush=True)
    if options.record:
        minutes = round((time.monotonic() - started) / 60.0, 1)
        shown = {"runs": options.runs, "minutes": minutes, "found": found}
        write_result("fuzz_readers", "python -m benchmarks.fuzz_readers", shown)
    return 0 if set(found.values()) == {"nothing"} else 1


if __name__ == "__main__":
    sys.exit(main())
