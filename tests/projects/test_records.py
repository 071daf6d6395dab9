"""Records are the same wherever a checkout lies, and notice what they were made from."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from ikgen.cli.main import run
from ikgen.projects.config import load_config
from ikgen.projects.stale import why_stale

pytestmark = pytest.mark.usefixtures("solved_once")

EXAMPLE = Path(__file__).resolve().parents[2] / "examples/cmake_only/urdf"
CONFIG = """
[[arm]]
name = "arm"
robot = "urdf/arm.urdf.xacro"
out = "generated"
samples = 20
"""


@pytest.fixture
def installed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder of a package `wrist_parts` that is installed outside of every project."""
    prefix = tmp_path / "somewhere/else/install"
    share = prefix / "share/wrist_parts"
    share.mkdir(parents=True)
    shutil.copy(EXAMPLE / "wrist.xacro", share)
    (share / "package.xml").write_text("<package><name>wrist_parts</name></package>")
    index = prefix / "share/ament_index/resource_index/packages"
    index.mkdir(parents=True)
    (index / "wrist_parts").touch()
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(prefix))
    return share


def project(folder: Path) -> Path:
    """A project whose robot file includes one of the installed package's files."""
    (folder / "urdf").mkdir(parents=True)
    text = (EXAMPLE / "arm.urdf.xacro").read_text()
    assert 'filename="wrist.xacro"' in text
    found = text.replace('filename="wrist.xacro"', 'filename="$(find wrist_parts)/wrist.xacro"')
    (folder / "urdf/arm.urdf.xacro").write_text(found)
    (folder / "ikgen.toml").write_text(CONFIG)
    return folder


def reason(folder: Path) -> str:
    (arm,) = load_config(folder / "ikgen.toml")
    return why_stale(arm, verify=False)


def test_a_record_does_not_depend_on_where_the_checkout_lies(
    tmp_path: Path, installed: Path
) -> None:
    near, deep = project(tmp_path / "near"), project(tmp_path / "one/two/three/deep")
    assert run(["build", str(near / "ikgen.toml"), "--no-verify", "-q"]) == 0
    assert run(["build", str(deep / "ikgen.toml"), "--no-verify", "-q"]) == 0
    record = (near / "generated/arm_ik.json").read_bytes()
    assert record == (deep / "generated/arm_ik.json").read_bytes()
    assert list(json.loads(record)["inputs"]) == [
        "../urdf/arm.urdf.xacro", "package://wrist_parts/wrist.xacro"
    ]  # fmt: skip


def test_files_of_installed_packages_count(
    tmp_path: Path, installed: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = project(tmp_path / "here")
    config, rule = str(folder / "ikgen.toml"), tmp_path / "rule.d"
    assert run(["build", config, "--no-verify", "-q", "--depfile", str(rule)]) == 0
    assert (installed / "wrist.xacro").as_posix() in rule.read_text()
    assert reason(folder) == ""
    with (installed / "wrist.xacro").open("a") as stream:
        stream.write("<!-- a remark -->")
    assert reason(folder) == "package://wrist_parts/wrist.xacro has changed"
    monkeypatch.delenv("AMENT_PREFIX_PATH")
    assert reason(folder) == ""  # a machine without the package cannot tell
