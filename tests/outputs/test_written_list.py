"""Reports and maps do not replace what somebody else wrote or edited."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from tests.support.small_robots import write_robot

from ikgen.cli.main import run
from ikgen.errors import UsageError
from ikgen.outputs.written_list import digests_listed, publish_listed

pytestmark = pytest.mark.usefixtures("solved_once")

REPORT = ["report", "elbow.urdf", "--task", "position", "--no-verify", "-q", "-o", "out"]


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a robot, as the current directory."""
    monkeypatch.chdir(tmp_path)
    write_robot(tmp_path / "elbow.urdf")
    return tmp_path


def test_what_changes_nothing_or_is_ours_is_written(tmp_path: Path) -> None:
    out = tmp_path / "out"
    for text in ("one", "one", "two"):
        assert publish_listed(out, "map", {"map.html": text}) == (out / "map.html",)
    assert (out / "map.html").read_text() == "two"
    (out / "other.html").write_text("theirs")
    publish_listed(out, "map", {"other.html": "theirs"})  # as it is to become
    assert {path.name for path in digests_listed(out, "map")} == {"map.html", "other.html"}


@pytest.mark.parametrize("name", ["map.html", "new.html", "map.json"])
def test_what_is_edited_or_unknown_is_kept(tmp_path: Path, name: str) -> None:
    publish_listed(tmp_path, "map", {"map.html": "one"})
    (tmp_path / name).write_text("mine")
    with pytest.raises(UsageError, match=f"{name} (was edited after|is in no record)") as caught:
        publish_listed(tmp_path, "map", {"map.html": "two", "new.html": "two"})
    assert "--force" in caught.value.hint and (tmp_path / name).read_text() == "mine"
    publish_listed(tmp_path, "map", {"map.html": "two", "new.html": "two"}, force=True)
    assert (tmp_path / "map.html").read_text() == "two"
    publish_listed(tmp_path, "map", {"map.html": "three", "new.html": "three"})


def test_what_is_removed_was_ours(tmp_path: Path) -> None:
    publish_listed(tmp_path, "map", {"map/1": b"one", "map/2": b"two"})
    gone = tmp_path / "map/2"
    publish_listed(tmp_path, "map", {"map/1": b"one"}, [gone])
    assert not gone.exists() and len(digests_listed(tmp_path, "map")) == 1
    gone.write_bytes(b"theirs")
    with pytest.raises(UsageError, match="2 is in no record"):
        publish_listed(tmp_path, "map", {"map/1": b"one"}, [gone])


def test_list_that_names_places_outside_says_nothing(tmp_path: Path) -> None:
    text = json.dumps({"generator": "ikgen", "files": {"../mine": "0" * 64}})
    (tmp_path / "map.json").write_text(text)
    assert digests_listed(tmp_path, "map") == {}


def test_edited_report_needs_force(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(REPORT) == run(REPORT) == 0
    write_robot(here / "elbow.urdf", reach=0.4)
    assert run(REPORT) == 0  # another text, of our own
    page = here / "out/elbow_report.html"
    page.write_text(page.read_text() + "<!-- mine -->")
    assert run(REPORT) == 2
    assert "out/elbow_report.html was edited after" in capsys.readouterr().err
    assert page.read_text().endswith("<!-- mine -->")
    assert run([*REPORT, "--force"]) == 0
    assert not page.read_text().endswith("<!-- mine -->")


def test_report_beside_code_is_replaced_by_either_command(here: Path) -> None:
    code = ["from-urdf", "elbow.urdf", "--task", "position", "--no-verify", "-q", "-o", "out"]
    for command in ([*code, "--emit", "python,report"], REPORT, [*code, "--emit", "report"]):
        assert run(command) == 0
        write_robot(here / "elbow.urdf", reach=0.3 + 0.01 * len(command))
