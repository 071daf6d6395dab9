"""The build hook for setuptools: what ends a build."""

from __future__ import annotations

from pathlib import Path

import pytest

pytest.importorskip("setuptools")

from setuptools.errors import ExecError

from ikgen.errors import BadDescriptionError
from ikgen.projects import setuptools as hook


def test_a_project_without_a_config_is_told_what_to_write(tmp_path: Path) -> None:
    with pytest.raises(ExecError, match=r"no \[tool.ikgen\]: write one \(ikgen init ROBOT"):
        hook.generate_arms(tmp_path)


@pytest.mark.parametrize(("hint", "ending"), [("", "odd"), ("mend it", "odd; mend it")])
def test_an_error_ends_with_its_way_out_where_there_is_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, hint: str, ending: str
) -> None:
    def refuse(path: Path) -> None:
        raise BadDescriptionError("odd", file=str(path), line=None, hint=hint)

    (tmp_path / "ikgen.toml").touch()
    monkeypatch.setattr(hook, "load_config", refuse)
    with pytest.raises(ExecError) as caught:
        hook.generate_arms(tmp_path)
    assert str(caught.value).startswith("ikgen: ") and str(caught.value).endswith(ending)
