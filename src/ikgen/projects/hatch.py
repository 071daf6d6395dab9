"""Build hook for hatchling: a Python package whose wheel carries its robot's generated modules.

```toml
[build-system]
requires = ["hatchling", "ikgen"]
build-backend = "hatchling.build"

[tool.hatch.build.hooks.ikgen]   # optional: config = "ikgen.toml", verify = false

[[tool.ikgen.arm]]
name = "ur5e"
robot = "urdf/ur5e.urdf"
out = "src/my_robot"
```
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface
from hatchling.plugin import hookimpl

from ikgen.errors import IkgenError, UsageError
from ikgen.projects.config import default_config, load_config
from ikgen.projects.project_build import build_arms

__all__ = ["IkgenBuildHook", "hatch_register_build_hook"]

_SOURCE = "src"


class IkgenBuildHook(BuildHookInterface):  # type: ignore[type-arg]
    """Generates the arms of the config before a wheel or an editable install is made."""

    PLUGIN_NAME = "ikgen"

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Bring all arms up to date and add their files to the build."""
        root = Path(self.root)
        named = self.config.get("config")
        config = root / str(named) if named else default_config(root)
        if config is None:
            raise UsageError(
                "the ikgen build hook finds no ikgen.toml and no [tool.ikgen]",
                hint="write one (ikgen init ROBOT does), or take the hook out of pyproject.toml",
            )
        arms = load_config(config)
        verify = bool(self.config.get("verify", True))
        for outcome in build_arms(arms, verify=verify, progress=self._say):
            if outcome.exit_code:
                raise IkgenError(outcome.error, hint=outcome.hint)
            for path in outcome.files:
                inside = os.path.relpath(path.resolve(), root.resolve())
                place = Path(inside).as_posix()  # where it is: a source distribution is the project
                if self.target_name != "sdist":
                    place = _in_wheel(Path(inside))
                build_data["force_include"][str(path.resolve())] = place

    def _say(self, stage: str, detail: str) -> None:
        self.app.display_info(f"ikgen: {detail}")


def _in_wheel(path: Path) -> str:
    """Where a file of the project lies in the wheel: `src/` is not part of the package's path."""
    parts = path.parts[1:] if path.parts[0] == _SOURCE else path.parts
    return "/".join(parts)


@hookimpl
def hatch_register_build_hook() -> type[IkgenBuildHook]:
    """For hatchling."""
    return IkgenBuildHook
