"""Configs, incremental builds and what counts as stale."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np
import pytest
from tests.support.small_robots import write_robot

import ikgen
from ikgen.cli.main import run
from ikgen.errors import ArgumentError, BadDescriptionError
from ikgen.projects.config import default_config, load_config
from ikgen.projects.depfile import depfile_text
from ikgen.projects.stale import why_stale

pytestmark = pytest.mark.usefixtures("solved_once")

FIXTURES = Path(__file__).resolve().parents[2] / "urdf_fixtures"
EXAMPLE = Path(__file__).resolve().parents[2] / "examples/cmake_only/urdf"
CONFIG = """
[[arm]]
name = "kuka"
robot = "kuka_kr6r900sixx.urdf"
base = "base_link"
tip = "tool0"
out = "generated"
samples = 20

[[arm]]
name = "small"
robot = "arm.urdf.xacro"
args = { upper_arm = 0.42 }
out = "generated"
samples = 20
"""


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    shutil.copy(FIXTURES / "kuka_kr6r900sixx.urdf", tmp_path)
    for name in ("arm.urdf.xacro", "wrist.xacro"):
        shutil.copy(EXAMPLE / name, tmp_path)
    (tmp_path / "ikgen.toml").write_text(CONFIG)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def stale(package: Path) -> dict[str, str]:
    arms = load_config(package / "ikgen.toml")
    return {arm.name: why_stale(arm, verify=False) for arm in arms}


def test_builds_only_what_is_stale(package: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["build", "--check"]) == 1
    assert not (package / "generated").exists()
    assert run(["build", "--no-verify", "--depfile", "d"]) == 0
    assert {p.name for p in (package / "generated").iterdir()} == {
        "kuka_ik.py", "kuka_ik.json", "small_ik.py", "small_ik.json"
    }  # fmt: skip
    rule = (package / "d").read_text()
    assert "wrist.xacro" in rule and Path(ikgen.__file__).as_posix() in rule
    assert run(["build", "--check", "--no-verify"]) == 0
    before = (package / "generated/kuka_ik.py").stat().st_mtime_ns
    wrist = package / "wrist.xacro"
    wrist.write_text(wrist.read_text().replace("0.38", "0.39"))
    assert stale(package) == {"kuka": "", "small": "wrist.xacro has changed"}
    capsys.readouterr()
    assert run(["build", "--no-verify", "--json"]) == 0
    made = {row["name"]: row["generated"] for row in json.loads(capsys.readouterr().out)["arms"]}
    assert made == {"kuka": False, "small": True}
    assert (package / "generated/kuka_ik.py").stat().st_mtime_ns == before
    assert run(["verify", "--samples", "20"]) == 0


def test_reasons(package: Path) -> None:
    assert run(["build", "--no-verify", "-q"]) == 0
    config = package / "ikgen.toml"
    config.write_text(CONFIG.replace("0.42", "0.43"))
    assert "args" in stale(package)["small"]
    config.write_text(CONFIG.replace('tip = "tool0"', ""))
    assert stale(package)["kuka"] == "'tip' was tool0, is not given"
    config.write_text(CONFIG)
    with (package / "generated/kuka_ik.py").open("a") as stream:
        stream.write("#")
    assert "was edited" in stale(package)["kuka"]
    record = package / "generated/small_ik.json"
    record.write_text(record.read_text().replace('"version": "', '"version": "0.'))
    assert "made by ikgen" in stale(package)["small"]


def test_what_was_never_verified_is_stale(
    package: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (package / "ikgen.toml").write_text(CONFIG[CONFIG.rindex("[[arm]]") :])
    assert run(["build", "--no-verify", "-q"]) == 0
    assert run(["build", "--check"]) == 1
    assert capsys.readouterr().out == "small: stale: not verified yet\n"
    assert run(["build", "--check", "--no-verify"]) == 0
    assert run(["build"]) == 0
    assert "(not verified yet)" in capsys.readouterr().out
    made = (package / "generated/small_ik.json").read_text()
    assert run(["build", "--check"]) == run(["build", "--no-verify"]) == 0
    assert (package / "generated/small_ik.json").read_text() == made


def test_what_ikgen_wrote_is_replaced_and_nothing_else(
    package: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (package / "ikgen.toml").write_text(CONFIG[CONFIG.rindex("[[arm]]") :])
    module = package / "generated/small_ik.py"
    module.parent.mkdir(exist_ok=True)
    module.write_text("# mine\n")
    assert run(["build", "--no-verify"]) == 2
    said = capsys.readouterr().err
    assert "generated/small_ik.py is in no record of ikgen" in said and "another `out`" in said
    assert module.read_text() == "# mine\n"
    module.unlink()
    assert run(["build", "--no-verify", "-q"]) == 0
    made = module.read_text()
    for lost in (None, "{"):
        module.write_text(made + "#\n")
        record = package / "generated/small_ik.json"
        record.unlink() if lost is None else record.write_text(lost)
        assert run(["build", "--no-verify", "-q"]) == 0
        assert module.read_text() == made


def test_one_bad_arm_leaves_the_others(package: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (package / "ikgen.toml").write_text(CONFIG.replace('"tool0"', '"tol0"'))
    assert run(["build", "--no-verify"]) == 2
    assert "error: ikgen.toml:6: kuka: no link named 'tol0'" in capsys.readouterr().err
    assert (package / "generated/small_ik.py").is_file()


def test_the_traceback_of_an_internal_error(
    package: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fail(*_: object) -> None:
        raise RuntimeError("broken\nin two")

    monkeypatch.setattr("ikgen.generation.generate.generate", fail)
    assert run(["build", "--jobs", "1"]) == 70
    said = capsys.readouterr().err
    assert "error: kuka: internal error: RuntimeError: broken in two" in said
    assert "-v shows the traceback" in said and "Traceback" not in said
    assert run(["build", "--jobs", "1", "-v"]) == 70
    said = capsys.readouterr().err
    assert 'raise RuntimeError("broken\\nin two")' in said and "-v shows" not in said


def test_an_error_of_the_system_is_told_as_by_every_command(
    package: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fail(*_: object) -> None:
        raise PermissionError(13, "Permission denied", "generated/kuka_ik.py")

    monkeypatch.setattr("ikgen.generation.generate.generate", fail)
    assert run(["build", "--jobs", "1"]) == 2
    said = capsys.readouterr().err
    assert "kuka: generated/kuka_ik.py: Permission denied" in said
    assert "hint: check the path and its permissions" in said


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "lists no arm"),
        ("x = ", "not TOML"),
        ("[[arm]]\nname = 'a'", "no 'robot'"),
        ("[[arm]]\nrobot = 'a'", "no 'name'"),
        ("[[arm]]\nname = 'a-b'\nrobot = 'r'", "not an identifier"),
        ("[[arm]]\nname = 'a'\nrobot = 'r'\nemmit = []", "unknown entry 'emmit'"),
        ("[[arm]]\nname = 'a'\nrobot = 'r'\nemit = 'cpp'", "not a list"),
        ("[[arm]]\nname = 'a'\nrobot = 'r'\nlock = { j = 'x' }", "not a finite number"),
        ("[[arm]]\nname = 'a'\nrobot = 'r'\n[[arm]]\nname = 'a'\nrobot = 'r'", "two arms"),
        ("arm = 3", "lists no arm"),
        ("[[arm]]\nname = 'a'\nrobot = 'r'\npackage_paths = ['no']", "no such directory: .*no"),
        ("[[arms]]\nname = 'a'\nrobot = 'r'", "unknown entry 'arms'"),
        ("[[arm]]\nname = 'a'\nrobot = 'r'\nemit = []", "names no output"),
        ("[[arm]]\nname = 'a'\nrobot = 'r'\ntool_axis = 'w'", "no tool axis named 'w'"),
        (
            "[[arm]]\nname = 'a'\nrobot = 'r'\ntask = 'position-pitch:x'\ntool_axis = 'y'",
            "arm.0..task: the task 'position-pitch:x' goes by another axis than y",
        ),
        ("other = 3\n[[arm]]\nname = 'a'\nrobot = 'r'", "unknown entry 'other'"),
    ],
)
def test_bad_configs(tmp_path: Path, text: str, said: str) -> None:
    path = tmp_path / "ikgen.toml"
    path.write_text(text)
    with pytest.raises(BadDescriptionError, match=said) as caught:
        load_config(path)
    assert caught.value.hint


@pytest.mark.parametrize(
    ("entry", "option", "said", "hint"),
    [
        ("name = 'a-b'", ["--name", "a-b"], "'a-b' is not an identifier", "for example 'a_b'"),
        ("maintainer = 'Ada'", ["--maintainer", "Ada"], "'Ada' is not written NAME <EMAIL>",
         "for example 'Ada Lovelace <ada@example.com>'"),
        ("couple = { j = 'k*' }", ["--couple", "j=k*"], "'k*' is not SOURCE*k+c",
         "write SOURCE*k+c, for example stage_1*1+0"),
    ],
)  # fmt: skip
def test_options_arguments_and_entries_are_refused_in_the_same_words(
    tmp_path: Path, capsys: pytest.CaptureFixture[str],
    entry: str, option: list[str], said: str, hint: str,
) -> None:  # fmt: skip
    path = tmp_path / "ikgen.toml"
    name = "" if entry.startswith("name") else "name = 'a'\n"
    path.write_text(f"[[arm]]\nrobot = 'r'\n{name}{entry}\n")
    with pytest.raises(BadDescriptionError) as caught:
        load_config(path)
    assert said in caught.value.message and caught.value.hint.startswith(hint)
    robot = write_robot(tmp_path / "elbow.urdf")
    assert run(["from-urdf", str(robot), *option]) == 2
    told = capsys.readouterr().err
    assert f"error: {option[0]}" in told and said in told and f"hint: {hint}" in told
    arguments = {"name": {"name": "a-b"}, "couple": {"couple": {"j": "k*"}}}
    if option[0][2:] in arguments:
        with pytest.raises(ArgumentError) as refused:
            ikgen.load(robot, **arguments[option[0][2:]])
        assert said in refused.value.message and refused.value.hint.startswith(hint)


def test_pyproject(tmp_path: Path) -> None:
    path = tmp_path / "pyproject.toml"
    path.write_text("[project]\nname = 'x'\n")
    assert default_config(tmp_path) is None
    path.write_text("[[tool.ikgen.arm]]\nname = 'a'\nrobot = 'r.urdf'\nfree = ['j']\n")
    assert default_config(tmp_path) == path
    (arm,) = load_config(path)
    assert arm.request.robot == tmp_path / "r.urdf" and arm.request.free == {"j": None}


@pytest.mark.parametrize("text", ["", "tool = 1", "[tool]\nikgen = 1", "[tool.other]"])
def test_a_pyproject_without_a_table_of_ikgen_is_told(tmp_path: Path, text: str) -> None:
    path = tmp_path / "pyproject.toml"
    path.write_text(text)
    with pytest.raises(BadDescriptionError, match=r"has no \[tool.ikgen\]"):
        load_config(path)


def test_a_pyproject_in_another_encoding_is_a_config_that_is_told(tmp_path: Path) -> None:
    path = tmp_path / "pyproject.toml"
    path.write_bytes("[project]\nauthors = ['Müller']\n".encode("latin-1"))
    assert default_config(tmp_path) is None
    path.write_bytes(path.read_bytes() + b"[[tool.ikgen.arm]]\nname = 'a'\n")
    assert default_config(tmp_path) == path
    with pytest.raises(BadDescriptionError, match="utf-8") as caught:
        load_config(path)
    assert "save it as UTF-8" in caught.value.hint


def test_depfile_escapes() -> None:
    text = depfile_text("build/a.stamp", [Path("/a b/c#d$.urdf"), Path("/x")])
    assert text == "build/a.stamp: /a\\ b/c\\#d$$.urdf /x\n"


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("[[arm]]\nname = 'a'\nrobot = 'r'\nemmit = []", ":4: arm[0].emmit: unknown entry"),
        ("[[arm]]\nname = 'a'\nrobot = 'r'\n\n[[arm]]\nname = 'b-c'\nrobot = 'r'",
         ":6: arm[1].name: 'b-c' is not an identifier"),
        ("[[arm]]\nname = 'a'\nrobot = 'r'\nlock = { j = 'x' }", ":4: arm[0].lock.j: 'x' is not a"),
        ("[[arm]]\nname = 'a'\nrobot = 'r'\n[arm.lock]\nj = 'x'", ":5: arm[0].lock.j: 'x'"),
        ("[[arm]]\nname = 'a'", ":1: arm[0] has no 'robot'"),
        ("arm = [{ name = 'a' }]", ": arm[0] has no 'robot'"),
        ("x = ", ":1: not TOML"),
    ],
)  # fmt: skip
def test_bad_entries_are_named_with_their_line(tmp_path: Path, text: str, place: str) -> None:
    path = tmp_path / "ikgen.toml"
    path.write_text(text)
    with pytest.raises(BadDescriptionError) as caught:
        load_config(path)
    assert f"{path}{place}" in caught.value.message


def test_check_says_how_to_mend(package: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["build", "--check"]) == 1
    assert capsys.readouterr().err == "hint: ikgen build ikgen.toml\n"


@pytest.mark.parametrize("text", ['[[arm]]\nname = "arm"', '[[arm]]\nname = 3\nrobot = "a"'])
def test_what_an_entry_should_be_is_hinted_at(tmp_path: Path, text: str) -> None:
    (tmp_path / "ikgen.toml").write_text(text)
    with pytest.raises(BadDescriptionError) as told:
        load_config(tmp_path / "ikgen.toml")
    assert told.value.line and told.value.hint


def test_what_a_renamed_arm_left_is_told(package: Path, capsys: pytest.CaptureFixture[str]) -> None:
    config = package / "ikgen.toml"
    assert run(["build", "--no-verify"]) == 0
    assert "warning" not in capsys.readouterr().err
    config.write_text(config.read_text().replace('name = "small"', 'name = "tiny"'))
    for _ in range(2):  # the second time all is fresh
        assert run(["build", "--no-verify"]) == 0
        said = capsys.readouterr().err
        files = "generated/small_ik.py", "generated/small_ik.json"
        assert f"no arm of ikgen.toml makes the outputs of 'small': {', '.join(files)}\n" in said
        assert f"hint: unless something else makes them: rm {' '.join(files)}\n" in said
    assert run(["build", "--no-verify", "--json", "-q"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["left"] == [{"name": "small", "files": list(files)}]
    for file in files:
        (package / file).unlink()
    assert run(["build", "--no-verify"]) == 0
    assert "warning" not in capsys.readouterr().err


def test_what_others_have_in_a_folder_is_not_left(
    package: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Outputs that lie deeper, and files that are no records."""
    assert run(["build", "--no-verify", "-q"]) == 0
    shutil.copytree(package / "generated", package / "generated/deeper/still")
    (package / "generated/notes_ik.json").write_text("[]")
    assert run(["build", "--no-verify"]) == 0
    assert "no arm of" not in capsys.readouterr().err


def test_which_joints_are_held_is_said(package: Path, capsys: pytest.CaptureFixture[str]) -> None:
    robot = FIXTURES / "franka_fr3.urdf"
    (package / "ikgen.toml").write_text(
        f'[[arm]]\nname = "fr3"\nrobot = "{robot.as_posix()}"\ntip = "fr3_link8"\n'
    )
    assert run(["build", str(package / "ikgen.toml"), "--no-verify"]) == 0
    assert "fr3: holding fr3_joint7: " in capsys.readouterr().err


def test_a_record_that_a_config_lists_is_mended_by_the_config(
    package: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["build", "--no-verify", "-q"]) == 0
    (package / "generated/small_ik.py").unlink()
    for target in ("generated/small_ik.json", "generated"):
        capsys.readouterr()
        assert run(["verify", target, "--samples", "20"]) == 1
        text = "".join(capsys.readouterr())
        assert "ikgen build ikgen.toml" in text and "from-urdf" not in text
    (package / "ikgen.toml").write_text("[[arm]]\nwhat = 1\n")
    assert run(["verify", "generated/small_ik.json", "--samples", "20"]) == 1
    assert "ikgen from-urdf" in "".join(capsys.readouterr())


def test_values_of_joints_may_have_their_units(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_robot(tmp_path / "elbow.urdf")
    config = tmp_path / "ikgen.toml"

    def written(values: str) -> Path:
        config.write_text(f'[[arm]]\nname = "arm"\nrobot = "elbow.urdf"\n{values}\n')
        return config

    (arm,) = load_config(written('lock = { waist = "45deg" }\nfree = { elbow = "0.1rad" }'))
    assert arm.request.lock == {"waist": np.pi / 4} and arm.request.free == {"elbow": 0.1}
    assert run(["build", str(written('lock = { waist = "20mm" }'))]) == 2
    assert "'mm' is no unit of a joint that turns" in capsys.readouterr().err
    with pytest.raises(BadDescriptionError, match="waist: 'left' is not a finite") as caught:
        load_config(written('lock = { waist = "left" }'))
    assert '"45deg"' in caught.value.hint and caught.value.line == 4
    assert run(["build", str(written('lock = { waist = "45deg" }')), "--no-verify", "-q"]) == 0
    assert run(["build", str(config), "--check", "--no-verify"]) == 0
    written(f"lock = {{ waist = {np.pi / 4!r} }}")
    assert run(["build", str(config), "--check", "--no-verify"]) == 0
