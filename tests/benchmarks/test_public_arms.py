"""The arms that anybody has: each once, with a class, and run as a user would."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from benchmarks.corpus import main

from benchmarks import public_arms as module
from ikgen.errors import MissingToolError


@pytest.fixture(autouse=True)
def fixtures_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    def absent(source: str) -> tuple[str, ...]:
        raise MissingToolError(f"no {source}")

    monkeypatch.setattr(module, "robot_names", absent)


def test_arms_are_classed_and_mirror_images_left_out() -> None:
    rows = {row["name"]: row["family"] for row in module.public_arms()}
    assert rows["ur5e"] == "6R three parallel 2-4, orthogonal wrist"
    assert rows["franka_fr3"] == "7R one spherical triple"
    assert rows["open_manipulator_x"] == "4R"
    assert sum(name.startswith("abb_yumi") for name in rows) == 1  # its arms mirror each other


@pytest.mark.long
def test_one_is_run(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    written = tmp_path / "found.json"
    options = ["--public", "--arm", "open_manipulator_x", "--samples", "20", "--json", str(written)]
    assert main(options) == 0
    (found,) = json.loads(written.read_text())
    assert found["state"] == "solved" and 0.1 < found["waited"] < 600.0
    assert found["processor"] > 0.1
    assert "4R" in capsys.readouterr().out
    with pytest.raises(SystemExit):
        main([*options, "--record"])  # of the whole collection alone
