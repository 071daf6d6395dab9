"""Builds that are killed: nothing of them is left, no process and no folder."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

ROBOT = Path(__file__).resolve().parents[2] / "urdf_fixtures/kuka_kr6r900sixx.urdf"
ARM = '[[arm]]\nname = "{}"\nrobot = "arm.urdf"\nsamples = 100000\nemit = ["python", "cpp"]\n'

pytestmark = pytest.mark.skipif(not Path("/proc").is_dir(), reason="needs /proc")


def marked(text: str) -> list[int]:
    """Processes with a text in their environment."""
    found = []
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            if text.encode() in (folder / "environ").read_bytes():
                found.append(int(folder.name))
        except OSError:
            continue
    return found


def await_(condition: object, seconds: float = 30.0) -> bool:
    assert callable(condition)
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if condition():
            return True
        time.sleep(0.1)
    return False


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGKILL])
def test_workers_and_their_folders_end_with_the_build(tmp_path: Path, number: int) -> None:
    project, scratch = tmp_path / "project", tmp_path / "scratch"
    project.mkdir()
    scratch.mkdir()
    shutil.copy(ROBOT, project / "arm.urdf")
    (project / "ikgen.toml").write_text(ARM.format("first") + ARM.format("second"))
    mark = f"IKGEN_TEST_MARK={tmp_path}"
    build = subprocess.Popen(
        [sys.executable, "-m", "ikgen", "build", "-j2"],
        cwd=project,
        env={**os.environ, "TMPDIR": str(scratch), "IKGEN_TEST_MARK": str(tmp_path)},
        stderr=subprocess.PIPE,
    )
    try:
        assert await_(lambda: len(list(scratch.glob("ikgen-*"))) >= 2, 120.0)
        build.send_signal(number)
        said = build.communicate(timeout=30)[1].decode()
        assert await_(lambda: not marked(mark))
    finally:
        for left in marked(mark):
            os.kill(left, signal.SIGKILL)
    assert await_(lambda: not list(scratch.iterdir()))
    assert not list(project.glob("*_ik*")) and not list(project.glob(".ikgen-*"))
    if number == signal.SIGTERM:
        assert build.returncode == 143 and "error: ended by a signal" in said
        assert "Traceback" not in said
