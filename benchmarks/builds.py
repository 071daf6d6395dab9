"""How long builds take: many arms at once against one by one, and the check of many fresh arms.

    python -m benchmarks.builds [--arms 20] [--checked 50] [--samples 1000] [--jobs 2]

The arms are one xacro file with different lengths. Each single run is `ikgen from-urdf` in a process
of its own; the build is one `ikgen build`. Times are of the whole command, start included.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

URDF = Path(__file__).resolve().parents[1] / "examples/cmake_only/urdf"
BUILD_SHARE = 0.6
"""Most that a build on two cores may take of the time of single runs."""
CHECK_SECONDS = 0.5
"""Most that `ikgen build --check` may take for 50 fresh arms."""


@dataclass(frozen=True, slots=True)
class Times:
    """Seconds of the whole commands."""

    single: float
    build: float
    check: float

    @property
    def share(self) -> float:
        """The build's part of the time of the single runs."""
        return self.build / self.single


def length(index: int) -> str:
    """The upper arm of the arm `index` (m)."""
    return f"{0.4 + 0.001 * index:.3f}"


def write_config(folder: Path, arms: int, samples: int) -> Path:
    """A config with `arms` arms of different lengths, generated into `folder/generated`."""
    tables = [
        f'[[arm]]\nname = "arm_{i}"\nrobot = "{URDF.as_posix()}/arm.urdf.xacro"\n'
        f'args = {{ upper_arm = "{length(i)}" }}\nout = "generated"\nsamples = {samples}\n'
        for i in range(arms)
    ]
    path = folder / "ikgen.toml"
    path.write_text("\n".join(tables), encoding="utf-8")
    return path


def seconds(*arguments: object, cwd: Path) -> float:
    """How long one `ikgen` command takes; raises `CalledProcessError` if it fails."""
    command = [sys.executable, "-m", "ikgen", *map(str, arguments)]
    started = time.perf_counter()
    subprocess.run(command, cwd=cwd, check=True, capture_output=True)
    return time.perf_counter() - started


def single_runs(folder: Path, arms: int, samples: int) -> float:
    """The arms one after the other, a process each."""
    return sum(
        seconds(
            "from-urdf", URDF / "arm.urdf.xacro", "--arg", f"upper_arm:={length(i)}",
            "--name", f"arm_{i}", "--samples", samples, "-q", "-o", "single", cwd=folder,
        )
        for i in range(arms)
    )  # fmt: skip


def check_time(folder: Path, arms: int, repeats: int = 5) -> float:
    """`ikgen build --check` on fresh arms: the least of some runs."""
    write_config(folder, arms, 20)
    seconds("build", "--no-verify", "-q", cwd=folder)
    return min(seconds("build", "--check", "--no-verify", cwd=folder) for _ in range(repeats))


def measure(folder: Path, arms: int, checked: int, samples: int, jobs: int) -> Times:
    """All three times."""
    write_config(folder, arms, samples)
    build = seconds("build", "-q", "-j", jobs, cwd=folder)
    return Times(single_runs(folder, arms, samples), build, check_time(folder, checked))


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the times; 1 where a target is missed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--arms", type=int, default=20)
    parser.add_argument("--checked", type=int, default=50)
    parser.add_argument("--samples", type=int, default=1000)
    parser.add_argument("--jobs", type=int, default=2)
    chosen = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory() as name:
        times = measure(
            Path(name).resolve(), chosen.arms, chosen.checked, chosen.samples, chosen.jobs
        )
    print(f"{chosen.arms} single runs          {times.single:7.2f} s")
    print(
        f"one build, {chosen.jobs} at a time   {times.build:7.2f} s   "
        f"{100 * times.share:.0f} % (at most {100 * BUILD_SHARE:.0f} %)"
    )
    print(
        f"check of {chosen.checked} fresh arms  {times.check:7.2f} s   (at most {CHECK_SECONDS} s)"
    )
    return 0 if times.share <= BUILD_SHARE and times.check <= CHECK_SECONDS else 1


if __name__ == "__main__":
    sys.exit(main())
