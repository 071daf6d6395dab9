"""Environments with chosen packages alone, made without a network."""

from __future__ import annotations

import os
import subprocess
import sys
import sysconfig
import venv
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

__all__ = ["Environment", "numpy_alone", "without_ikgen"]


@dataclass(frozen=True, slots=True)
class Environment:
    """A virtual environment; `call` runs one of its commands outside of every checkout."""

    folder: Path

    @property
    def python(self) -> Path:
        """Its interpreter."""
        return self.folder / "bin/python"

    def install(self, *what: object) -> None:
        """Install a wheel, an sdist, or a project (`-e`), and nothing that it depends on."""
        pip = [sys.executable, "-m", "pip", "--python", self.python, "install", "--quiet"]
        done = subprocess.run(
            [str(w) for w in (*pip, "--no-deps", "--no-build-isolation", *what)],
            text=True,
            capture_output=True,
        )
        assert done.returncode == 0, done.stdout + done.stderr

    def call(self, command: str, *arguments: object, cwd: Path) -> str:
        """Run a command of the environment; its output, which must be that of a success."""
        hidden = ("PYTHONPATH", "VIRTUAL_ENV")
        done = subprocess.run(
            [str(w) for w in (self.folder / "bin" / command, *arguments)],
            cwd=cwd,
            env={k: v for k, v in os.environ.items() if k not in hidden},
            text=True,
            capture_output=True,
        )
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout


def numpy_alone(folder: Path) -> Environment:
    """An environment with NumPy and nothing else."""
    return _linked(folder, lambda name: name.split("-")[0].split(".")[0] == "numpy")


def without_ikgen(folder: Path) -> Environment:
    """An environment with what is installed here, but for ikgen."""
    return _linked(folder, lambda name: "ikgen" not in name and not name.startswith("__"))


def _linked(folder: Path, wanted: Callable[[str], bool]) -> Environment:
    """An environment whose packages are links to those of the running one."""
    venv.create(folder, with_pip=False)
    here = Path(sysconfig.get_path("purelib"))
    site = folder / here.relative_to(sys.prefix)
    for entry in here.iterdir():
        if wanted(entry.name):
            (site / entry.name).symlink_to(entry)
    return Environment(folder)
