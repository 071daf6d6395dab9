"""Projects in folders with odd names, files with odd times, robots behind links."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from tests.support.solving import NO_COMPILER

ELBOW = Path(__file__).resolve().parents[2] / "examples/setuptools_robot/urdf/elbow.urdf"
CONFIG = """[[arm]]
name = "arm"
robot = "arm.urdf"
task = "position"
emit = [{emit}]
samples = 30
"""

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="names and links as on Linux")


def project(folder: Path, emit: str = '"python"') -> Path:
    folder.mkdir()
    shutil.copy(ELBOW, folder / "arm.urdf")
    (folder / "ikgen.toml").write_text(CONFIG.format(emit=emit), encoding="utf-8")
    return folder


def build(folder: Path, *options: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "ikgen", "build", *options]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, errors="replace")


@pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER)
def test_a_folder_with_spaces_quotes_newlines_and_bytes(tmp_path: Path) -> None:
    """Compiled and verified there, by a temporary folder of such a name too."""
    name = os.fsdecode(b"a b'c\"d\ne$(f)\xff")
    folder = project(tmp_path / name, '"python", "cpp"')
    scratch = tmp_path / f"{name} too"
    scratch.mkdir()
    environment = {**os.environ, "TMPDIR": str(scratch)}
    command = [sys.executable, "-m", "ikgen", "build", "-q"]
    done = subprocess.run(command, cwd=folder, capture_output=True, env=environment)
    assert done.returncode == 0, done.stderr
    assert build(folder, "--check").returncode == 0
    assert not list(scratch.iterdir())


@pytest.mark.parametrize("time", [1.0, 4e9])
def test_times_that_are_past_or_to_come_make_nothing_stale(tmp_path: Path, time: float) -> None:
    folder = project(tmp_path / "project")
    assert build(folder, "-q", "--no-verify").returncode == 0
    for path in folder.iterdir():
        os.utime(path, (time, time))
    assert build(folder, "--check", "--no-verify").returncode == 0
    (folder / "arm.urdf").write_text(ELBOW.read_text().replace("0.3 0 0", "0.31 0 0"))
    os.utime(folder / "arm.urdf", (time, time))
    assert build(folder, "--check", "--no-verify").returncode == 1


def test_a_robot_behind_a_link_is_the_file_that_it_leads_to(tmp_path: Path) -> None:
    folder = project(tmp_path / "project")
    (folder / "arm.urdf").rename(folder / "first.urdf")
    (folder / "arm.urdf").symlink_to("first.urdf")
    assert build(folder, "-q", "--no-verify").returncode == 0
    text = (folder / "first.urdf").read_text().replace("0.3 0 0", "0.31 0 0")
    (folder / "second.urdf").write_text(text)
    (folder / "arm.urdf").unlink()
    (folder / "arm.urdf").symlink_to("second.urdf")
    assert build(folder, "--check", "--no-verify").returncode == 1
    (folder / "second.urdf").unlink()
    done = build(folder, "--no-verify")
    assert done.returncode == 2 and "no such file" in done.stderr
