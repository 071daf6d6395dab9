"""Samples of runs that are killed, meet a full disk, or run beside each other; the whole are the commands
`python -m benchmarks.kills`, `faults` and `pairs`."""

from __future__ import annotations

import shutil
import subprocess
import sys

import pytest
from benchmarks.command_line import REPOSITORY

SAMPLES = {
    "kills": ("--kills", "3", "--seed", "1"),
    "faults": ("--most", "6", "--seed", "1"),
    "pairs": ("--pairs", "3", "--seed", "1"),
}


@pytest.mark.skipif(sys.platform != "linux", reason="needs forks, signals and LD_PRELOAD")
@pytest.mark.long  # kills at any moment: tests/outputs/test_publish.py
@pytest.mark.parametrize("name", SAMPLES)
def test_nothing_is_lost_or_half(name: str) -> None:
    if name == "faults" and shutil.which("cc") is None:
        pytest.skip("needs a C compiler")
    command = [sys.executable, "-m", f"benchmarks.{name}", *SAMPLES[name]]
    done = subprocess.run(command, cwd=REPOSITORY, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout
