"""The tools that tests of build steps need, and how they are found."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

__all__ = ["environment", "finished", "needs_cmake", "needs_colcon", "printed"]

_OURS = str(Path(sys.executable).parent)
_COLCON = os.environ.get("COLCON") or shutil.which("colcon")
_HIDDEN = ("VIRTUAL_ENV", "PYTHONPATH")

needs_cmake = pytest.mark.skipif(
    any(shutil.which(tool) is None for tool in ("cmake", "g++", "make")),
    reason="needs cmake, make and g++",
)
needs_colcon = pytest.mark.skipif(
    _COLCON is None
    or not (Path("/usr/share/ament_cmake").is_dir() or "AMENT_PREFIX_PATH" in os.environ)
    or any(shutil.which(tool) is None for tool in ("cmake", "g++", "bash")),
    reason="needs colcon (on PATH or in the variable COLCON), ament_cmake, cmake and g++",
)


def environment(*, ament: bool = False) -> dict[str, str]:
    """The variables with the commands of this environment first on PATH; last for ament, whose
    python3 has to be the system's."""
    path = [folder for folder in os.environ["PATH"].split(os.pathsep) if folder != _OURS]
    last = ["/usr/bin", *path, str(Path(_COLCON or "").parent), _OURS]
    path = last if ament else [_OURS, *path]
    kept = {name: value for name, value in os.environ.items() if name not in _HIDDEN}
    return kept | {"PATH": os.pathsep.join(path)}


def finished(*command: object, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    """What became of a command, run with those of this environment first on PATH."""
    words = [str(word) for word in command]
    return subprocess.run(words, cwd=cwd, env=environment(), text=True, capture_output=True)


def printed(*command: object, cwd: Path | None = None) -> str:
    """What a command that has to succeed prints."""
    done = finished(*command, cwd=cwd)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout + done.stderr
