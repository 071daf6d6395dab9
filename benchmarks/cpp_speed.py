"""Times emitted C++ headers: ns per solve, with plain -O3 and for this machine; single, batch, in threads.

python benchmarks/cpp_speed.py generated/ur5e_ik.hpp ...
"""

from __future__ import annotations

import argparse
import re
import subprocess
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from ikgen.verify.runners.cpp_toolchain import find_compiler, find_eigen

SOURCE = Path(__file__).resolve().parent / "cpp" / "bench.cpp"
FLAGS = {
    "plain": ["-O3"],
    "avx2": ["-O3", "-mavx2", "-mfma"],
    "native": ["-O3", "-march=native"],
}


@contextmanager
def compiled_program(
    source: Path, header: Path, flags: Sequence[str], libraries: Sequence[str] = ()
) -> Iterator[Path]:
    """A program of this folder compiled with an emitted header, for as long as the context lasts."""
    text = header.read_text(encoding="utf-8")
    held = int(re.search(r"constexpr int kFree = [1-9]", text) is not None)
    defines = [
        f'-DIKGEN_HEADER="{header.name}"', f"-DIKGEN_NAMESPACE={header.stem}", f"-DIKGEN_FREE={held}"
    ]  # fmt: skip
    includes = [f"-I{header.resolve().parent}", "-isystem", str(find_eigen())]
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder) / "program"
        command = [*find_compiler(), "-std=c++17", "-pthread", *flags, *defines, *includes]
        subprocess.run([*command, str(source), "-o", str(program), *libraries], check=True)
        yield program


def run_program(
    source: Path, header: Path, flags: Sequence[str], libraries: Sequence[str] = ()
) -> tuple[float, list[float]]:
    """Compile a program of this folder with an emitted header: seconds that takes, and the numbers that
    the program prints."""
    start = time.perf_counter()
    with compiled_program(source, header, flags, libraries) as program:
        seconds = time.perf_counter() - start
        output = subprocess.run([str(program)], check=True, capture_output=True, text=True).stdout
        return seconds, [float(x) for x in output.split()]


def measure(header: Path, flags: list[str], limits: bool) -> tuple[float, list[float]]:
    """Seconds to compile, then what the program prints: ns per solve, ns per pose of a batch, mean number
    of solutions, ns per pose of a long span in one thread and split among all, number of threads."""
    return run_program(SOURCE, header, [*flags, f"-DIKGEN_LIMITS={str(limits).lower()}"])


def main() -> None:
    """Print one line a header and set of flags."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("headers", type=Path, nargs="+")
    parser.add_argument("--flags", choices=FLAGS, nargs="+", default=["plain", "native"])
    parser.add_argument(
        "--no-limits", action="store_true", help="count rows outside the limits too"
    )
    options = parser.parse_args()
    print(
        f"{'header':32} {'flags':8} {'solve ns':>9} {'batch ns':>9} {'rows':>6} "
        f"{'compile s':>10} {'scaling':>16}"
    )
    for header in options.headers:
        for name in options.flags:
            seconds, numbers = measure(header.resolve(), FLAGS[name], not options.no_limits)
            single, batch, rows, one, split, threads = numbers
            scaling = f"{one / split:.2f} on {threads:.0f} cores"
            print(
                f"{header.stem:32} {name:8} {single:9.1f} {batch:9.1f} {rows:6.2f} "
                f"{seconds:10.1f} {scaling:>16}"
            )


if __name__ == "__main__":
    main()
