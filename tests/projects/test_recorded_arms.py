"""Outputs in a folder without a config are made again from their records."""

from __future__ import annotations

import shutil
from pathlib import Path
from xml.etree import ElementTree

import pytest
from tests.support.tools import finished

from ikgen.cli.main import run
from ikgen.errors import UsageError
from ikgen.model.maintainer import checked_maintainer, name_and_email
from ikgen.projects.recorded_arms import arms_below
from ikgen.records.codec import CodecError, Decoder
from ikgen.records.request import Request

pytestmark = pytest.mark.usefixtures("solved_once")

FIXTURES = Path(__file__).resolve().parents[2] / "urdf_fixtures"
ADA = "Ada Lovelace <ada@example.com>"


@pytest.fixture
def workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A description and two outputs of it in `src`, one of them a package."""
    shutil.copy(FIXTURES / "scara_standard.toml", tmp_path)
    monkeypatch.chdir(tmp_path)
    command = ["from-dh", "scara_standard.toml", "--emit", "python,moveit", "-o", "src", "-q"]
    who = ["--maintainer", ADA, "--license", "BSD-3-Clause"]
    assert run([*command, *who, "--no-verify"]) == 0
    return tmp_path


def test_the_package_says_whose_it_is(workspace: Path) -> None:
    (manifest,) = workspace.rglob("package.xml")
    read = ElementTree.parse(manifest)
    maintainer = read.find("maintainer")
    assert maintainer is not None
    assert (maintainer.text, maintainer.get("email")) == ("Ada Lovelace", "ada@example.com")
    assert read.findtext("license") == "BSD-3-Clause"


def test_all_outputs_of_an_arm_are_made_again(
    workspace: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (arm,) = arms_below(workspace / "src")
    assert set(arm.outputs.emit) == {"python", "moveit"} and arm.request.maintainer == ADA
    assert run(["build", "src", "--check", "--no-verify"]) == 0
    table = workspace / "scara_standard.toml"
    table.write_text(table.read_text().replace("l_1 = ", "l_1 = 1"))
    assert run(["build", "src", "--check", "--no-verify"]) == 1
    assert "hint: ikgen build src" in capsys.readouterr().err
    assert run(["build", "src", "--no-verify", "-q"]) == 0
    assert run(["build", "src", "--check", "--no-verify"]) == 0
    (manifest,) = workspace.rglob("package.xml")
    assert "ada@example.com" in manifest.read_text()


def test_a_package_regenerates_itself_from_anywhere(workspace: Path) -> None:
    (script,) = workspace.rglob("regenerate.sh")
    command = ["sh", script, "--no-verify"]
    before = script.with_name("package.xml").read_text()
    script.with_name("package.xml").write_text("")
    told = finished(*command, "--check", cwd=Path("/"))
    assert told.returncode == 1 and "package.xml was edited" in told.stdout
    assert finished(*command, "--force", cwd=Path("/")).returncode == 0
    assert script.with_name("package.xml").read_text() == before


def test_a_package_that_was_moved_is_told_where_its_description_is(
    workspace: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (script,) = workspace.rglob("regenerate.sh")
    other = workspace / "far/away" / script.parent.name
    shutil.move(script.parent, other)
    command = ["build", str(other), "--no-verify"]
    for words, code in (([], 2), (["--check"], 1)):
        assert run([*command, *words]) == code
        hint = (
            f"hint: ikgen build {other.as_posix()} --robot FILE (the description, where it is now)"
        )
        assert hint in capsys.readouterr().err
    assert run([*command, "--check", "--robot", "scara_standard.toml"]) == 1
    hint = f"hint: ikgen build {other.as_posix()} --robot scara_standard.toml\n"
    assert hint in capsys.readouterr().err
    assert run([*command, "--robot", "scara_standard.toml"]) == 0
    assert '"robot": "../../../scara_standard.toml"' in (other / "scara_ik.json").read_text()
    assert run([*command, "--check"]) == 0
    assert "sh regenerate.sh --robot FILE" in " ".join((other / "README.md").read_text().split())
    assert 'ikgen build "$(dirname "$0")" "$@"' in (other / script.name).read_text()


def test_one_description_is_named_for_the_outputs_of_one(
    workspace: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    config = workspace / "ikgen.toml"
    config.write_text('[[arm]]\nname = "scara"\nrobot = "scara_standard.toml"\n')
    robot = ("--robot", "scara_standard.toml")
    assert run(["build", str(config), "--check", *robot]) == 2
    assert "hint: change it in" in capsys.readouterr().err
    shutil.copy("scara_standard.toml", "other.toml")
    command = ["from-dh", "other.toml", "--name", "other", "-o", "src", "-q", "--no-verify"]
    assert run(command) == 0
    assert run(["build", "src", "--check", *robot]) == 2
    assert "are of several descriptions" in capsys.readouterr().err


def test_a_folder_without_outputs_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["build", str(tmp_path)]) == 2
    assert "no outputs of ikgen below" in capsys.readouterr().err


@pytest.mark.parametrize(
    "text", ["ada", "<a@b.c>", "Ada <ada>", "Ada <a@b.c", 'A <"a@b.c>', "A\n<a@b.c>"]
)
def test_maintainers_that_no_manifest_takes_are_refused(
    text: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(UsageError, match="NAME <EMAIL>"):
        checked_maintainer(text)
    with pytest.raises(CodecError, match="NAME <EMAIL>"):
        Decoder().table(Request, {"robot": "a.urdf", "maintainer": text}, "arm[0]")
    assert run(["from-urdf", "a.urdf", "--maintainer", text]) == 2
    assert "ada@example.com" in capsys.readouterr().err


def test_a_maintainer_is_taken_apart() -> None:
    assert name_and_email(" Ada L. <ada@example.com> ") == ("Ada L.", "ada@example.com")
