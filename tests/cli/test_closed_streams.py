"""Standard streams that are closed, full, or read by nobody: no traceback."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ELBOW = Path(__file__).resolve().parents[2] / "examples/setuptools_robot/urdf/elbow.urdf"

pytestmark = pytest.mark.skipif(os.name == "nt", reason="needs sh")


@pytest.mark.parametrize(
    ("streams", "code"),
    [(">&-", 0), ("2>&-", 0), (">&- 2>&-", 0), (">/dev/full", 2), ("| head -c 1", 0)],
)
def test_streams(streams: str, code: int) -> None:
    if "/dev/full" in streams and not Path("/dev/full").exists():
        pytest.skip("needs /dev/full")
    line = f'"{sys.executable}" -m ikgen inspect "{ELBOW}" --json {streams}'
    done = subprocess.run(["sh", "-c", line], capture_output=True, text=True)
    assert done.returncode == code, done.stderr
    assert "Traceback" not in done.stderr and "Exception ignored" not in done.stderr
