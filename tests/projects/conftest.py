"""A project of two small arms."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

ROBOT = Path(__file__).resolve().parents[2] / "examples/setuptools_robot/urdf/elbow.urdf"
ARM = '[[arm]]\nname = "{}"\nrobot = "elbow.urdf"\ntask = "position"\nsamples = 20\n'


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Two arms, as the current directory."""
    shutil.copy(ROBOT, tmp_path)
    (tmp_path / "ikgen.toml").write_text(ARM.format("first") + ARM.format("second"))
    monkeypatch.chdir(tmp_path)
    return tmp_path
