"""The command line from outside: exit codes, streams, files."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import pytest
from tests.support.redundant_arms import SHOULDER_ELBOW_WRIST, TORSO, Joint, serial_urdf
from tests.support.small_robots import write_robot

from ikgen.cli.main import run
from ikgen.projects.config import load_config
from ikgen.records.record import read_record

pytestmark = pytest.mark.usefixtures("solved_once")

FIXTURES = Path(__file__).resolve().parents[2] / "urdf_fixtures"
KUKA = FIXTURES / "kuka_kr6r900sixx.urdf"
SCARA = FIXTURES / "scara_standard.toml"
ELBOW = FIXTURES.parent / "examples/setuptools_robot/urdf/elbow.urdf"
INCLUDING = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:include filename="parts/elbow.urdf"/>
</robot>
"""
Ended = subprocess.CompletedProcess[str]
Called = Callable[..., Ended]
AR4 = FIXTURES / "ar4_ros_driver/annin_ar4_description/urdf/ar.urdf.xacro"


def ikgen(*arguments: object, cwd: Path | None = None, **environment: str) -> Ended:
    command = [sys.executable, "-m", "ikgen", *map(str, arguments)]
    return subprocess.run(
        command, cwd=cwd, text=True, capture_output=True, env={**os.environ, **environment}
    )


@pytest.fixture
def at_once(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Called:
    """What becomes of a command where nothing hangs on a process of its own."""

    def call(*arguments: object, cwd: Path | None = None) -> Ended:
        if cwd is not None:
            monkeypatch.chdir(cwd)
        words = list(map(str, arguments))
        code = run(words)
        said = capsys.readouterr()
        return subprocess.CompletedProcess(words, code, said.out, said.err)

    return call


def refused(result: Ended, code: int = 2) -> str:
    """The message of a command that ended with an error; never a traceback."""
    assert result.returncode == code, result.stderr
    assert "Traceback" not in result.stderr
    assert "\nerror: " in "\n" + result.stderr
    return result.stderr


def test_generates_and_verifies(tmp_path: Path) -> None:
    done = ikgen("from-urdf", KUKA, "-o", tmp_path, "--samples", 50)
    assert done.returncode == 0, done.stderr
    assert "verifying" in done.stderr
    for part in ("base_link -> tool0", "spherical wrist", "theta_1", "at most 8", "0 missed"):
        assert part in done.stdout
    names = sorted(path.name for path in tmp_path.iterdir())
    assert names == ["kuka_kr6r900sixx_ik.json", "kuka_kr6r900sixx_ik.py"]
    again = ikgen("verify", tmp_path, "--samples", 50)
    assert again.returncode == 0, again.stderr
    assert "right" in again.stdout


def test_text_that_cannot_be_imported_is_not_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from ikgen.emit.python import python_emitter as python

    broken = {"kuka_kr6r900sixx_ik.py": 'NAME = "open\n'}
    monkeypatch.setattr(python, "emit_derivation", lambda derivation: broken)
    assert run(["from-urdf", str(KUKA), "-o", str(tmp_path / "out"), "-q"]) == 1
    message = capsys.readouterr().err
    assert "the emitted python code cannot be imported: SyntaxError" in message
    assert tempfile.gettempdir() not in message
    assert not (tmp_path / "out").exists()


def test_a_reader_that_has_enough_is_no_error() -> None:
    command = [sys.executable, "-m", "ikgen", "inspect", str(FIXTURES / "ur5e.urdf"), "--no-advice"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT) as inspect:
        assert inspect.stdout is not None
        inspect.stdout.readline()
        inspect.stdout.close()
        assert inspect.wait() == 0


def test_json_alone_is_on_stdout(tmp_path: Path) -> None:
    done = ikgen(
        "from-urdf", KUKA, "-o", tmp_path, "--samples", 20, "--json", "--name", "arm", "-v"
    )
    record = json.loads(done.stdout)
    assert record["joints"][0] == "joint_a1" and record["max_solutions"] == 8
    assert record["verification"]["python"]["passed"] and record["name"] == "arm"
    assert "behavior tree:" in done.stderr


def test_quiet_says_nothing(tmp_path: Path) -> None:
    done = ikgen("from-urdf", KUKA, "-o", tmp_path, "--no-verify", "-q")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_same_input_gives_the_same_bytes(tmp_path: Path) -> None:
    """All kinds of outputs, from checkouts at two depths and with two orders of sets."""
    made = []
    for name, seed in (("near", "1"), ("one/two/deep", "2")):
        (tmp_path / name / "urdf/parts").mkdir(parents=True)
        shutil.copy(ELBOW, tmp_path / name / "urdf/parts")
        (tmp_path / name / "urdf/arm.urdf.xacro").write_text(INCLUDING)
        done = ikgen(
            *("from-urdf", "urdf/arm.urdf.xacro", "--task", "position", "-o", "out", "-q"),
            *("--emit", "python,cpp,cpp-package,nanobind,moveit,report", "--no-verify"),
            cwd=tmp_path / name,
            PYTHONHASHSEED=seed,
        )
        assert done.returncode == 0, done.stderr
        out = tmp_path / name / "out"
        made.append({p.relative_to(out): p.read_bytes() for p in out.rglob("*") if p.is_file()})
    near, deep = made
    assert near.keys() == deep.keys()
    assert [str(path) for path in near if near[path] != deep[path]] == []
    suffixes = {path.suffix for path in near}
    assert {".py", ".hpp", ".json", ".cpp", ".toml", ".xml", ".tex", ".html"} <= suffixes
    assert [str(path) for path in near if str(tmp_path).encode() in near[path]] == []
    assert b"parts/elbow.urdf" in near[Path("arm_ik.json")]


def test_a_xacro_file_and_its_arguments(tmp_path: Path, at_once: Called) -> None:
    arguments = ("--arg", "ar_model:=mk3", "--arg", "include_gripper:=false")
    done = at_once(
        "from-urdf", AR4, *arguments, "--samples", 20, "-o", tmp_path, "--depfile", tmp_path / "d"
    )
    assert done.returncode == 0, done.stderr
    assert "mk3.yaml" in (tmp_path / "d").read_text()
    assert "ar_model" in refused(at_once("from-urdf", AR4, "-o", tmp_path / "none"))
    assert not (tmp_path / "none").exists()


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["from-urdf"], "Missing argument"),
        (["from-urdf", "nothing.urdf"], "no such file"),
        (["from-urdf", KUKA, "--tip", "tol0"], "tool0"),
        (["from-urdf", KUKA, "--task", "pse"], "pose"),
        (["from-urdf", KUKA, "--emit", "pythn"], "python"),
        (["from-urdf", KUKA, "--emit", ""], "names no output"),
        (["from-urdf", KUKA, "--lock", "joint_a1"], "JOINT=VALUE"),
        (["from-urdf", KUKA, "--lock", "joint_a1=nan"], "finite"),
        (["from-urdf", KUKA, "--free", "joint_a9"], "joint_a1"),
        (["from-urdf", KUKA, "--free", "joint_a1=x"], "number"),
        (["from-urdf", KUKA, "--arg", "a=b"], "NAME:=VALUE"),
        (["from-urdf", KUKA, "--name", "my-arm"], "my_arm"),
        (["from-urdf", KUKA, "--samples", "0"], "samples"),
        (["from-urdf", KUKA, "--package-path", "nowhere"], "nowhere"),
        (["from-urdf", FIXTURES / "abb_yumi.urdf"], "gripper_l_base"),
        (["from-urdf", FIXTURES], "is a folder"),
        (["from-dh", KUKA], "from-urdf"),
        (["from-dh", SCARA, "--base", "base"], "--base"),
        (["inspect", SCARA, "--base", "base"], "leave base out"),
        (["inspect", SCARA, "--arg", "a:=b"], "leave args out"),
        (["report", SCARA, "--package-path", FIXTURES], "leave package_paths out"),
        (["from-urdf", KUKA, "--depfile-target", "arm"], "give --depfile FILE"),
        (["inspect", "nothing.urdf"], "no such file"),
        (["verify", "nowhere"], "no such file or directory"),
        (["build", "nothing.toml"], "no such file"),
        (["build"], "ikgen.toml"),
        (["verify"], "no outputs"),
        (["frm-urdf"], "frm-urdf"),
    ],
    ids=lambda value: " ".join(map(str, value))[-40:] if isinstance(value, list) else "",
)
def test_bad_input_is_explained(
    tmp_path: Path, at_once: Called, arguments: list[object], said: str
) -> None:
    assert said in refused(at_once(*arguments, cwd=tmp_path))
    assert not any(tmp_path.iterdir())


def test_seven_joints_need_no_option(tmp_path: Path, at_once: Called) -> None:
    done = at_once(
        "from-urdf", FIXTURES / "franka_fr3.urdf", "-o", tmp_path, "--samples", 30, "--json"
    )
    assert done.returncode == 0, done.stderr
    line = "holding fr3_joint7: closed form by rules (position apart from rotation, two branches a step)"
    assert (
        f"\n{line} with it held; others: fr3_joint6 (a narrower range), fr3_joint4 (" in done.stderr
    )
    record = json.loads(done.stdout)
    assert record["free"] == record["chosen"]["held"] == ["fr3_joint7"]
    assert record["chosen"]["task"] == "pose" and record["chosen"]["why"] in line
    assert record["verification"]["python"]["passed"]
    written = json.loads((tmp_path / "fr3_ik.json").read_text())
    assert written["free"] == {"fr3_joint7": None} and written["asked"]["free"] == {}
    before = (tmp_path / "fr3_ik.py").read_bytes()
    again = read_record(tmp_path / "fr3_ik.json").again()
    assert again.free == {"fr3_joint7": None}
    done = at_once(*again.command("-o", str(tmp_path), "--no-verify").split()[1:])
    assert done.returncode == 0 and "holding" not in done.stderr
    assert (tmp_path / "fr3_ik.py").read_bytes() == before


@pytest.mark.parametrize("lift", [(), (TORSO,)], ids=["S-R-S", "P and S-R-S"])
def test_redundant_arms_need_no_option(
    tmp_path: Path, at_once: Called, lift: tuple[Joint, ...]
) -> None:
    path = tmp_path / "arm.urdf"
    path.write_text(serial_urdf("arm", [*lift, *SHOULDER_ELBOW_WRIST]))
    done = at_once("from-urdf", path, "-o", tmp_path, "--samples", 30, "--json")
    assert done.returncode == 0, done.stderr
    record = json.loads(done.stdout)
    assert len(record["chosen"]["held"]) == 1 + len(lift)
    assert all(step["branches"] <= 2 for step in record["solved"])
    assert record["verification"]["python"]["passed"]


def test_init_lists_every_arm(tmp_path: Path, at_once: Called) -> None:
    write_robot(tmp_path / "twin.urdf", sides=("left_", "right_"))
    done = at_once("init", "twin.urdf", "--emit", "python,cpp", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stdout.endswith("wrote: ikgen.toml\nnext: ikgen build\n")
    arms = load_config(tmp_path / "ikgen.toml")
    assert [arm.name for arm in arms] == ["twin_left_tool0", "twin_right_tool0"]
    assert {arm.request.base for arm in arms} == {"base_link"}
    assert {arm.request.tip for arm in arms} == {"left_tool0", "right_tool0"}
    told = refused(at_once("init", "twin.urdf", cwd=tmp_path))
    assert "is there already" in told and "--add" in told
    assert at_once("init", "twin.urdf", "--force", cwd=tmp_path).returncode == 0
    built = at_once("build", "--no-verify", cwd=tmp_path)
    assert built.returncode == 0, built.stderr
    assert (tmp_path / "generated/twin_left_tool0_ik.py").is_file()


def test_a_folder_that_cannot_be_made(tmp_path: Path, at_once: Called) -> None:
    (tmp_path / "file").write_text("")
    refused(at_once("from-urdf", KUKA, "-o", tmp_path / "file", "--no-verify"))


def test_inspect_writes_nothing(tmp_path: Path, at_once: Called) -> None:
    done = at_once("inspect", FIXTURES / "doosan_m1013.urdf", "--json", cwd=tmp_path)
    record = json.loads(done.stdout)
    assert record["chain"]["dof"] == 6 and record["chain"]["snaps"]
    assert record["chain"]["deviation"]["m"] > 0
    text = at_once("inspect", FIXTURES / "abb_yumi.urdf", cwd=tmp_path)
    assert text.returncode == 0 and text.stdout.count("--base yumi_base_link --tip") == 2
    assert not any(tmp_path.iterdir())


def test_help_and_version_import_nothing_heavy() -> None:
    code = (
        "import sys; from ikgen.cli.main import run; run({!r}); "
        "print([m for m in ('numpy','sympy','pinocchio','xacro','jinja2','rich',"
        "'py_trees','lxml') if m in sys.modules])"
    )
    for arguments in (["--help"], ["--version"], ["from-urdf", "--help"], ["build", "--check"]):
        done = subprocess.run(
            [sys.executable, "-c", code.format(arguments)], text=True, capture_output=True
        )
        assert done.stdout.splitlines()[-1] == "[]", (arguments, done.stdout, done.stderr)


def test_what_writes_reports_is_imported_where_one_is_written() -> None:
    code = "import sys, ikgen.generation.generate; print('ikgen.report' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], text=True, capture_output=True)
    assert done.stdout == "False\n", done.stderr


def test_an_internal_error_is_one_line(monkeypatch: pytest.MonkeyPatch, capsys) -> None:  # type: ignore[no-untyped-def]
    from ikgen.cli import main

    def fail(**_: object) -> None:
        raise RuntimeError("broken\nin two")

    monkeypatch.setattr(main.ikgen, "main", fail)
    assert main.run(["inspect", "x"]) == 70
    message = capsys.readouterr().err
    assert "internal error: RuntimeError: broken in two" in message
    assert "Traceback" not in message
    main.run(["inspect", "x", "-v"])
    assert "Traceback" in capsys.readouterr().err


def test_doctor_and_cmake_dir() -> None:
    found = json.loads(ikgen("doctor", "--json").stdout)
    assert found["packages"]["numpy"] and {"viser", "distributed", "zarr"} <= found["tools"].keys()
    lines = ikgen("doctor").stdout.splitlines()
    assert max(len(line) - len(line.split("  ")[-1]) for line in lines) < 100  # no path pads others
    folder = Path(ikgen("cmake-dir").stdout.strip())
    assert (folder / "ikgenConfig.cmake").is_file()


def test_report(tmp_path: Path, at_once: Called) -> None:
    done = at_once("report", ELBOW, "--task", "position", "-o", tmp_path, "--json")
    files = [Path(name) for name in json.loads(done.stdout)["files"]]
    assert {".tex", ".html"} <= {path.suffix for path in files}
    assert all(path.is_file() and path.stat().st_size for path in files)


def test_from_dh(tmp_path: Path, at_once: Called) -> None:
    row = '[[joints]]\ntype = "revolute"\nalpha = {}\na = {}\nd = {}\ntheta = 0\n'
    rows = [(0, 0, 0), ('"-pi/2"', 0, 0), (0, 0.43, 0.15), ('"-pi/2"', 0.02, 0.43)]
    rows += [('"pi/2"', 0, 0), ('"-pi/2"', 0, 0)]
    text = 'name = "puma"\nconvention = "modified"\n' + "".join(row.format(*r) for r in rows)
    (tmp_path / "puma.toml").write_text(text)
    done = at_once("from-dh", "puma.toml", "-o", "out", "--samples", 20, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert at_once("verify", "out", "--samples", 20, cwd=tmp_path).returncode == 0
    (tmp_path / "puma.toml").write_text(text.replace("0.43", "0.44"))
    assert "mm and" in refused(at_once("verify", "out", "--samples", 20, cwd=tmp_path), 1)
