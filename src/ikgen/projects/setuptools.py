"""Build hook for setuptools: a Python package whose wheel carries its robot's generated modules.

```toml
[build-system]
requires = ["setuptools>=64", "ikgen"]
build-backend = "setuptools.build_meta"

[tool.setuptools.cmdclass]
build_py = "ikgen.projects.setuptools.BuildPy"

[[tool.ikgen.arm]]
name = "ur5e"
robot = "urdf/ur5e.urdf"
out = "src/my_robot"
```
"""

from __future__ import annotations

from pathlib import Path

from setuptools.command.build_py import build_py
from setuptools.errors import ExecError

from ikgen.errors import IkgenError
from ikgen.processes.executors import Workers
from ikgen.projects.config import default_config, load_config
from ikgen.projects.project_build import build_arms

__all__ = ["BuildPy", "generate_arms"]


class BuildPy(build_py):  # type: ignore[misc]  # setuptools has no types
    """`build_py` that first generates the arms of the config, into the packages that it copies."""

    def run(self) -> None:
        """Bring all arms up to date, then build; in an editable install too."""
        generate_arms(Path.cwd())
        self.__dict__.pop("data_files", None)  # cached before the modules were there
        super().run()


def generate_arms(root: Path) -> None:
    """Generate what is stale of a project's config; raises `ExecError`, which ends a build."""
    config = default_config(root)
    if config is None:
        raise ExecError(
            "the ikgen build hook finds no ikgen.toml and no [tool.ikgen]: write one (ikgen init ROBOT "
            "does), or take BuildPy out of pyproject.toml"
        )
    try:
        # One job: a worker process would run a setup.py without a main guard once more.
        outcomes = list(build_arms(load_config(config), workers=Workers(count=1)))
    except IkgenError as error:
        raise _ended(error.message, error.hint) from None
    for outcome in outcomes:
        if outcome.exit_code:
            raise _ended(outcome.error, outcome.hint)


def _ended(message: str, hint: str) -> ExecError:
    """The error that ends a build, with the way out where there is one."""
    return ExecError("; ".join(filter(None, [f"ikgen: {message}", hint])))
