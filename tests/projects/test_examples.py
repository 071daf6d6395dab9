"""Each example does what its README says: its commands, run in a copy."""

from __future__ import annotations

import importlib.util
import shutil
import subprocess
from pathlib import Path

import pytest
from tests.support.precompiled import OPTIONS
from tests.support.snippets import blocks
from tests.support.tools import environment, needs_cmake, needs_colcon

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = sorted(path.parent.name for path in (ROOT / "examples").glob("*/*") if path.is_file())
_NEEDS = {
    "ament_description": (needs_colcon, pytest.mark.slow),
    "cmake_only": (needs_cmake,),
    "hatch_robot": (),
    "setuptools_robot": (pytest.mark.long,),  # its wheel: test_python_packages.py
    "python_quickstart": (),
}
_SAID = {
    "ament_description": "0 errors, 0 failures",
    "cmake_only": "100% tests passed",
    "hatch_robot": "[[",
    "setuptools_robot": "[[",
    "python_quickstart": "50 of 50 poses",
}


_ELSEWHERE = {"plugin_leaf", "plugin_rust", "plugin_task"}  # tests/conformance/test_plugin_*.py


def test_every_example_is_run() -> None:
    assert set(EXAMPLES) - _ELSEWHERE == set(_NEEDS) == set(_SAID)


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=marks, id=name) for name, marks in _NEEDS.items()]
)
def test_the_readme_works(name: str, tmp_path: Path) -> None:
    for tool in {"hatch_robot": ["hatchling"], "setuptools_robot": ["setuptools"]}.get(name, []):
        if importlib.util.find_spec(tool) is None:
            pytest.skip(f"needs {tool}")
    made = shutil.ignore_patterns(
        "*_ik.*", "build", "prismatic", "site", "out", "*.egg-info", "generated"
    )
    shutil.copytree(ROOT / "examples" / name, tmp_path / "examples" / name, ignore=made)
    shutil.copytree(ROOT / "urdf_fixtures", tmp_path / "urdf_fixtures")
    commands = [
        b.text for b in blocks(ROOT / "examples" / name / "README.md") if b.language == "sh"
    ]
    assert commands
    # what the README tells to install first is there
    lines = [x for x in "".join(commands).splitlines() if "pip install --quiet" not in x]
    done = subprocess.run(
        ["bash", "-euc", "\n".join(lines)],
        cwd=tmp_path / "examples" / name,
        env=environment(ament=name == "ament_description") | {"CXXFLAGS": OPTIONS},
        text=True,
        capture_output=True,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert _SAID[name] in done.stdout
