"""Where the build hook of hatchling puts what was generated."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from ikgen.projects import hatch
from ikgen.projects.project_build import Outcome


@pytest.mark.parametrize(
    ("target", "place"), [("wheel", "pkg/arm_ik.py"), ("sdist", "src/pkg/arm_ik.py")]
)
def test_an_sdist_is_the_project_and_a_wheel_its_packages(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, target: str, place: str
) -> None:
    made = tmp_path / "src/pkg/arm_ik.py"
    (tmp_path / "ikgen.toml").write_text('[[arm]]\nname = "arm"\nrobot = "arm.urdf"\n')
    done = Outcome("arm", "not generated yet", (made,))
    monkeypatch.setattr(hatch, "build_arms", lambda *_, **__: [done])
    hook = hatch.IkgenBuildHook(str(tmp_path), {}, None, None, str(tmp_path), target)  # type: ignore[arg-type]
    data: dict[str, Any] = {"force_include": {}}
    hook.initialize("standard", data)
    assert data["force_include"] == {str(made): place}
