"""libFuzzer on the emitted C++ header: bytes become poses, joint values, seeds and options.

    python -m benchmarks.fuzz_header [--runs N] [--seed N] [--arms FILE ...] [--record]

Each arm's header is compiled with AddressSanitizer and UndefinedBehaviorSanitizer
(`benchmarks/cpp/fuzz.cpp`) and run N times. Wrong is what a sanitizer says, an allocation, a row that is
not finite or does not give the pose, a solve that takes more than ten seconds. Exit code 1 where anything
is. Needs clang with libFuzzer.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from benchmarks.command_line import FIXTURES, Source, emit
from benchmarks.cpp_speed import compiled_program
from benchmarks.results import write_result

__all__ = ["clang_with_fuzzer", "main"]

SOURCE = Path(__file__).resolve().parent / "cpp" / "fuzz.cpp"
ARMS = ("kuka_kr6r900sixx.urdf", "ur5e.urdf", "scara_standard.toml")
"""A spherical wrist, three parallel axes, a slide."""

FLAGS = ("-O2", "-g", "-fsanitize=fuzzer,address,undefined", "-fno-sanitize-recover=all")


def clang_with_fuzzer() -> str | None:
    """The compiler, or None where it or its library for fuzzing is not there."""
    clang = shutil.which("clang++")
    if clang is None:
        return None
    probe = 'extern "C" int LLVMFuzzerTestOneInput(const char*, unsigned long) { return 0; }'
    command = [clang, "-fsanitize=fuzzer,address", "-x", "c++", "-", "-o", os.devnull]
    done = subprocess.run(command, input=probe, text=True, capture_output=True)
    return clang if done.returncode == 0 else None


def fuzz(robot: Path, runs: int, seed: int) -> tuple[str, float]:
    """What was found in one arm's header ("nothing", or the words), and in how many seconds."""
    folder = Path(tempfile.mkdtemp(prefix="fuzz-"))
    try:
        made = emit(Source(robot.stem, "", robot), folder, "cpp")
        if made.header is None:
            raise RuntimeError(f"{robot}: {made.answer}")
        whole = int('kTask = "pose"' in made.header.read_text(encoding="utf-8"))
        flags = (*FLAGS, f"-DFUZZ_WHOLE={whole}")
        with compiled_program(SOURCE, made.header, flags) as program:
            options = [f"-runs={runs}", f"-seed={seed}", "-max_len=256", "-timeout=10"]
            started = time.monotonic()
            done = subprocess.run(
                [program, *options, "-print_final_stats=1"], capture_output=True, cwd=folder
            )
            seconds = time.monotonic() - started
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    said = done.stderr.decode("utf-8", "replace")
    if done.returncode == 0 and f"number_of_executed_units: {runs}" in said:
        return "nothing", seconds
    lines = re.findall(r"(?m)^.*(?:fuzz:|ERROR|runtime error|SUMMARY).*$", said)
    return " | ".join(lines[:4]) or said[-300:], seconds


def main() -> int:
    """Fuzz each arm's header."""
    parser = argparse.ArgumentParser(description="libFuzzer on the emitted C++ header.")
    parser.add_argument("--runs", type=int, default=1_000_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--arms", nargs="+", type=Path, default=[FIXTURES / name for name in ARMS])
    parser.add_argument("--record", action="store_true", help="write the recorded result")
    options = parser.parse_args()
    clang = clang_with_fuzzer()
    if clang is None:
        print("needs clang++ with libFuzzer")
        return 2
    os.environ["CXX"] = clang
    found, seconds = {}, 0.0
    for robot in options.arms:
        found[robot.stem], used = fuzz(robot, options.runs, options.seed)
        seconds += used
        print(
            f"{robot.stem:24} {options.runs:,} runs in {used:.0f} s: {found[robot.stem]}",
            flush=True,
        )
    if options.record:
        shown = {"runs": options.runs, "minutes": round(seconds / 60.0, 1), "found": found}
        write_result("fuzz_header", "python -m benchmarks.fuzz_header", shown)
    return 0 if set(found.values()) == {"nothing"} else 1


if __name__ == "__main__":
    sys.exit(main())
