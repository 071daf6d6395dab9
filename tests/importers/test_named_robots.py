"""Robots by name: where their files are found, and that nothing of this machine is written down."""

from __future__ import annotations

import json
import shutil
import sys
import types
from pathlib import Path

import pytest

import ikgen
from ikgen.cli.main import run
from ikgen.errors import MissingToolError, UnknownNameError
from ikgen.importers import load_tree, taken_arguments
from ikgen.importers.named_robots import find_robot, is_named, names_meant, robot_names

pytestmark = pytest.mark.usefixtures("solved_once")

ELBOW = Path(__file__).resolve().parents[2] / "examples/setuptools_robot/urdf/elbow.urdf"
FILES = {
    "elbow_description/urdf/elbow_robot.urdf": "elbow",
    "elbow_description/urdf/elbow.urdf": "",  # a name that another file has already
    "talos_data/robots/talos_left_arm.urdf": "talos_arm",
    "b1_description/urdf/b1-z1.urdf": "b1_z1",
}


@pytest.fixture(autouse=True)
def data(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A package like example-robot-data, installed."""
    site = tmp_path / "site"
    robots = site / "cmeel.prefix/share/example-robot-data/robots"
    for place in FILES:
        (robots / place).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ELBOW, robots / place)
    info = site / "example_robot_data-9.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: example-robot-data\nVersion: 9\n")
    monkeypatch.syspath_prepend(site)
    monkeypatch.setenv("IKGEN_CACHE_DIR", str(tmp_path / "cache"))
    monkeypatch.chdir(tmp_path)
    return robots


def test_what_is_a_name() -> None:
    assert is_named("example-robot-data:panda") and is_named(Path("robot_descriptions:x"))
    assert not is_named("C:robot.urdf") and not is_named("example-robot-data")


def test_names_are_those_of_the_loaders(data: Path) -> None:
    assert robot_names("example-robot-data") == ("b1_z1", "elbow", "talos_arm")
    place = find_robot("example-robot-data:talos_arm").file
    assert place == data / "talos_data/robots/talos_left_arm.urdf"


def test_a_robot_is_read_and_its_file_has_a_url() -> None:
    tree = load_tree("example-robot-data:elbow")
    assert tree.name == "elbow"
    ((file, url),) = tree.source.package_urls
    assert file.is_file() and url.startswith("package://example-robot-data/elbow_description/urdf/")


def test_a_name_that_there_is_not_is_told_with_those_there_are() -> None:
    with pytest.raises(UnknownNameError) as caught:
        load_tree("example-robot-data:elbo")
    assert caught.value.hint.startswith("there is: elbow")
    with pytest.raises(UnknownNameError):
        ikgen.load("example-robot-data:elbo")


def test_the_library_takes_names() -> None:
    arm = ikgen.load("example-robot-data:elbow", samples=50)
    assert arm.verification is not None and arm.verification.passed
    assert ikgen.load("example-robot-data:elbow", samples=50).source == arm.source


def test_records_and_configs_name_the_robot(tmp_path: Path) -> None:
    robot = "example-robot-data:elbow"
    assert (
        run(["from-urdf", robot, "--task", "position", "--samples", "50", "-q", "-o", "out"]) == 0
    )
    text = (tmp_path / "out/elbow_ik.json").read_text()
    assert json.loads(text)["robot"] == robot and "site" not in text
    assert run(["verify", "out", "--samples", "50"]) == 0
    assert run(["init", robot, "-q"]) == 0
    assert f'robot = "{robot}"' in (tmp_path / "ikgen.toml").read_text()
    assert run(["build", "-q"]) == 0 and run(["build", "--check"]) == 0


def test_robots_are_listed_with_their_arms(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["robots", "example-robot-data", "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)["robots"]
    assert [row["robot"].partition(":")[2] for row in rows] == ["b1_z1", "elbow", "talos_arm"]
    assert rows[1]["arms"][0]["dof"] == 3 and rows[1]["problem"] is None
    assert run(["robots", "example-robot-data"]) == 0
    assert "example-robot-data:elbow" in capsys.readouterr().out
    assert run(["robots", "other"]) == 2


def test_a_package_that_is_not_there_is_told_with_how_to_get_it(
    data: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.rmtree(data)
    monkeypatch.setattr("sys.prefix", "/nowhere")
    with pytest.raises(MissingToolError, match="not installed") as caught:
        load_tree("example-robot-data:elbow")
    assert "pip install" in caught.value.hint
    assert run(["inspect", "example-robot-data:elbow"]) == 2
    assert "pip install" in capsys.readouterr().err


def test_robot_descriptions_are_read_with_their_arguments(
    data: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = data.parent / "clone/pkg"
    folder.mkdir(parents=True)
    shutil.copy(ELBOW, folder / "elbow.urdf.xacro")
    package = types.ModuleType("robot_descriptions")
    package.__path__ = []
    package.__spec__ = types.SimpleNamespace(name="robot_descriptions")  # type: ignore[assignment]
    has = types.SimpleNamespace(has_urdf=True)
    package.DESCRIPTIONS = {"elbow_description": has}  # type: ignore[attr-defined]
    module = types.ModuleType("robot_descriptions.elbow_description")
    module.__dict__.update(
        REPOSITORY_PATH=str(folder.parent),
        PACKAGE_PATH=str(folder),
        XACRO_PATH=str(folder / "elbow.urdf.xacro"),
    )
    monkeypatch.setitem(sys.modules, "robot_descriptions", package)
    monkeypatch.setitem(sys.modules, module.__name__, module)
    for name in ("elbow", "elbow_description"):
        found = find_robot(f"robot_descriptions:{name}")
        assert found.file == folder / "elbow.urdf.xacro"
        assert found.package_paths == (folder.parent, folder)
    assert load_tree("robot_descriptions:elbow").source.package_urls[0][1] == (
        "package://robot_descriptions/pkg/elbow.urdf.xacro"
    )
    with pytest.raises(UnknownNameError):
        find_robot("robot_descriptions:knee")
    text = (folder / "elbow.urdf.xacro").read_text()
    argument = '<x:arg xmlns:x="http://www.ros.org/wiki/xacro" name="hand" default="none"/>'
    (folder / "elbow.urdf.xacro").write_text(text.replace("</robot>", f"{argument}</robot>"))
    assert taken_arguments("robot_descriptions:elbow") == {"hand": "none"}
    assert taken_arguments("robot_descriptions:knee") == {}


@pytest.mark.parametrize(
    ("typed", "meant"),
    [
        ("elbow", ("example-robot-data:elbow",)),
        ("B1-Z1", ("example-robot-data:b1_z1",)),
        ("example_robot_data:elbow", ("example-robot-data:elbow",)),
        ("robot-descriptions:ur5e", ("robot_descriptions:ur5e",)),
        ("C:robot", ()),
        ("arm", ()),
    ],
)
def test_what_is_meant_by_a_name_that_is_none_is_told(
    typed: str, meant: tuple[str, ...], capsys: pytest.CaptureFixture[str]
) -> None:
    assert names_meant(typed) == meant
    assert run(["from-urdf", typed]) == 2
    hint = f"a robot by name? {meant[0]}" if meant else "ikgen robots lists names"
    assert hint in capsys.readouterr().err
    with pytest.raises(ikgen.ArgumentError) as caught:
        ikgen.load(typed)
    assert not meant or hint in caught.value.hint
