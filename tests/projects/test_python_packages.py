"""Python packages whose wheel gets its generated module from a build hook."""

from __future__ import annotations

import importlib.util
import shutil
import subprocess
import sys
import zipfile
from importlib.metadata import entry_points
from pathlib import Path

import pytest
from tests.support.environments import numpy_alone, without_ikgen
from tests.support.sampled import sampled

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = {"hatch_robot": "hatchling", "setuptools_robot": "setuptools"}
needs_entry_point = pytest.mark.skipif(
    not any(entry.name == "ikgen" for entry in entry_points(group="hatch")),
    reason="needs an installation with the entry point",
)


def build_wheel(project: Path, out: Path) -> subprocess.CompletedProcess[str]:
    """Build a project's wheel as pip does, with the build backend of this environment."""
    return subprocess.run(
        [sys.executable, "-m", "pip", "wheel", "--no-deps", "--no-build-isolation", "-w", out, "."],
        cwd=project,
        text=True,
        capture_output=True,
    )


def examples(*always: str) -> pytest.MarkDecorator:
    """The test runs for these always, for all of them with the long tests."""
    return pytest.mark.parametrize("project", sampled(EXAMPLES, always), indirect=True)


@pytest.fixture
def project(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    """A copy of one of the examples."""
    pytest.importorskip(EXAMPLES[request.param])
    folder = tmp_path / str(request.param)
    shutil.copytree(ROOT / "examples" / folder.name, folder, ignore=shutil.ignore_patterns("*_ik*"))
    return folder


_USE = """
from {package} import arm_ik
q = [0.3, 0.5, -0.1, 0.4][: arm_ik.DOF]
pose = arm_ik.forward(q)
found = arm_ik.solve(pose)
assert len(found), found.status
assert any(abs(row - q).max() < 1e-9 for row in found)
print(arm_ik.__file__)
"""


@needs_entry_point
@examples("hatch_robot")
def test_the_wheel_works_with_numpy_alone(project: Path, tmp_path: Path) -> None:
    done = build_wheel(project, tmp_path / "prismatic")
    assert done.returncode == 0, done.stdout + done.stderr
    (wheel,) = (tmp_path / "prismatic").glob("*.whl")
    package = project.name
    with zipfile.ZipFile(wheel) as archive:
        names = set(archive.namelist())
    files = ("__init__.py", "py.typed", "arm_ik.py", "arm_ik.json")
    assert {f"{package}/{file}" for file in files} <= names
    environment = numpy_alone(tmp_path / "env")
    environment.install(wheel)
    said = environment.call("python", "-c", _USE.format(package=package), cwd=tmp_path)
    assert Path(said.strip()).is_relative_to(environment.folder)


@needs_entry_point
@examples("setuptools_robot")
def test_an_editable_install_has_the_module(project: Path, tmp_path: Path) -> None:
    environment = without_ikgen(tmp_path / "env")
    environment.install("-e", ROOT)
    environment.install("-e", project)
    said = environment.call("python", "-c", _USE.format(package=project.name), cwd=tmp_path)
    assert Path(said.strip()).is_relative_to(project)


@needs_entry_point
@examples("hatch_robot", "setuptools_robot")
def test_a_bad_description_ends_the_build(project: Path, tmp_path: Path) -> None:
    (description,) = (project / "urdf").iterdir()
    text = description.read_text()
    description.write_text(text.replace('<child link="tool0"/>', '<child link="gripper"/>'))
    done = build_wheel(project, tmp_path / "prismatic")
    assert done.returncode != 0
    assert "tool0" in done.stdout + done.stderr or "gripper" in done.stdout + done.stderr


@pytest.mark.slow
@pytest.mark.skipif(importlib.util.find_spec("mypy") is None, reason="needs mypy")
def test_the_installed_package_is_typed(tmp_path: Path) -> None:
    project = tmp_path / "setuptools_robot"
    shutil.copytree(ROOT / "examples/setuptools_robot", project)
    done = build_wheel(project, tmp_path / "prismatic")
    assert done.returncode == 0, done.stdout + done.stderr
    environment = numpy_alone(tmp_path / "env")
    environment.install(*(tmp_path / "prismatic").glob("*.whl"))
    (tmp_path / "use.py").write_text(
        "from setuptools_robot import arm_ik\n\n"
        "reveal_type(arm_ik.solve(arm_ik.forward([0.1, 0.2, 0.3])).q)\n"
        "reveal_type(arm_ik.JOINT_NAMES)\n"
    )
    checked = subprocess.run(
        [
            *(sys.executable, "-m", "mypy", "--strict", "--cache-dir", tmp_path / "cache"),
            *("--python-executable", environment.python, "use.py"),
        ],
        cwd=tmp_path,
        text=True,
        capture_output=True,
    )
    assert checked.returncode == 0, checked.stdout
    assert "ndarray" in checked.stdout and "str, ...]" in checked.stdout
