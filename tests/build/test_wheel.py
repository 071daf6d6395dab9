"""A wheel carries the templates, and the hatchling hook fills another package's wheel."""

from __future__ import annotations

import shutil
import subprocess
import sys
import zipfile
from importlib.metadata import entry_points
from pathlib import Path

import pytest

pytest.importorskip("hatchling")
ROOT = Path(__file__).resolve().parents[2]


def wheel(project: Path, out: Path) -> Path:
    """Build a wheel with the hatchling of this environment."""
    done = subprocess.run(
        [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(out)],
        cwd=project,
        text=True,
        capture_output=True,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return next(out.glob("*.whl"))


@pytest.fixture(scope="module")
def unpacked(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("wheel")
    with zipfile.ZipFile(wheel(ROOT, folder / "dist")) as archive:
        archive.extractall(folder / "site")
    return folder / "site"


def test_everything_is_in_the_wheel(unpacked: Path) -> None:
    for part in (
        "ikgen/templates/python/module.py.jinja",
        "ikgen/templates/cpp/header.hpp.jinja",
        "ikgen/templates/cmake/ikgenConfig.cmake",
        "ikgen/build/cmake_root/cmake/ikgenConfig.cmake",
        "ikgen/build/config.py",
    ):
        assert (unpacked / part).is_file(), part
    assert list(unpacked.glob("*.data/data/share/cmake/ikgen/ikgenConfig.cmake"))


def test_generates_from_the_wheel(unpacked: Path, tmp_path: Path) -> None:
    code = (
        f"import sys; sys.path.insert(0, {str(unpacked)!r}); import ikgen; "
        "from ikgen.cli.main import run; print(ikgen.__file__); sys.exit(run(sys.argv[1:]))"
    )
    robot = ROOT / "urdf_fixtures/kuka_kr6r900sixx.urdf"
    done = subprocess.run(
        [sys.executable, "-c", code, "from-urdf", robot, "--no-verify", "-q", "-o", tmp_path],
        cwd=tmp_path,
        text=True,
        capture_output=True,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith(str(unpacked))
    assert (tmp_path / "kuka_kr6r900sixx_ik.py").is_file()


@pytest.mark.skipif(
    not any(entry.name == "ikgen" for entry in entry_points(group="hatch")),
    reason="needs an installation with the entry point",
)
def test_the_hook_fills_a_wheel(tmp_path: Path) -> None:
    project = tmp_path / "robot"
    shutil.copytree(ROOT / "examples/hatch_robot", project)
    with zipfile.ZipFile(wheel(project, tmp_path / "dist")) as archive:
        names = set(archive.namelist())
    assert {"hatch_robot/__init__.py", "hatch_robot/arm_ik.py"} <= names
