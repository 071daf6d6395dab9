"""Times emitted C++ headers: ns per solve, with plain -O3 and for this machine, single and batch.

python benchmarks/cpp_speed.py generated/ur5e_ik.hpp ...
"""

from __future__ import annotations

import argparse
import subprocess
import tempfile
import time
from pathlib import Path

from ikgen.verify.runners.cpp_toolchain import find_compiler, find_eigen

SOURCE = Path(__file__).resolve().parent / "cpp" / "bench.cpp"
FLAGS = {
    "plain": ["-O3"],
    "avx2": ["-O3", "-mavx2", "-mfma"],
    "native": ["-O3", "-march=native"],
}


def measure(header: Path, flags: list[str], limits: bool) -> tuple[float, list[float]]:
    """Seconds to compile, then ns per solve, ns per pose of a batch, mean number of solutions."""
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder) / "bench"
        defines = [
            f'-DIKGEN_HEADER="{header.name}"',
            f"-DIKGEN_NAMESPACE={header.stem}",
            f"-DIKGEN_LIMITS={str(limits).lower()}",
        ]
        includes = [f"-I{header.parent}", "-isystem", str(find_eigen())]
        start = time.perf_counter()
        command = [*find_compiler(), "-std=c++17", *flags, *defines, *includes]
        subprocess.run([*command, str(SOURCE), "-o", str(program)], check=True)
        seconds = time.perf_counter() - start
        output = subprocess.run([str(program)], check=True, capture_output=True, text=True).stdout
        return seconds, [float(x) for x in output.split()]


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
        f"{'header':32} {'flags':8} {'solve ns':>9} {'batch ns':>9} {'rows':>6} {'compile s':>10}"
    )
    for header in options.headers:
        for name in options.flags:
            seconds, (single, batch, rows) = measure(
                header.resolve(), FLAGS[name], not options.no_limits
            )
            print(
                f"{header.stem:32} {name:8} {single:9.1f} {batch:9.1f} {rows:6.2f} {seconds:10.1f}"
            )


if __name__ == "__main__":
    main()
