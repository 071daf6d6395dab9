"""What the tutorial says works as it says."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest
from tests.support.snippets import follow

TUTORIAL = Path(__file__).resolve().parents[2] / "docs/tutorial"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """After the first page."""
    place = tmp_path_factory.mktemp("tutorial")
    assert follow(TUTORIAL / "first-robot.md", place) == 6
    return place


def test_first_robot(folder: Path) -> None:
    assert (folder / "generated/panda_ik.py").is_file()
    assert (folder / "generated/arm_ik.py").is_file()


def test_the_same_in_cpp(folder: Path) -> None:
    if not shutil.which("g++") or not shutil.which("pkg-config"):
        pytest.skip("needs g++ and pkg-config")
    if subprocess.run(["pkg-config", "--exists", "eigen3"]).returncode:
        pytest.skip("pkg-config knows no Eigen")
    assert follow(TUTORIAL / "cpp.md", folder) == 2
