"""`ikgen verify` notices what is wrong and says by how much."""

from __future__ import annotations

import json
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from tests.support.sampled import sampled
from tests.support.solving import NO_COMPILER

from ikgen.cli.main import run

pytestmark = pytest.mark.usefixtures("solved_once")

needs_compiler = pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER)
KUKA = Path(__file__).resolve().parents[2] / "urdf_fixtures" / "kuka_kr6r900sixx.urdf"


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A robot with generated outputs in `out`, and the current directory."""
    shutil.copy(KUKA, tmp_path / "arm.urdf")
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("GITHUB_ACTIONS", raising=False)
    monkeypatch.delenv("GITHUB_STEP_SUMMARY", raising=False)
    assert run(["from-urdf", "arm.urdf", "-o", "out", "--name", "arm", "--no-verify", "-q"]) == 0
    return tmp_path


def edit(path: Path, before: str, after: str) -> None:
    text = path.read_text()
    assert before in text
    path.write_text(text.replace(before, after))


def check(*arguments: str) -> int:
    return run(["verify", *arguments, "--samples", "20"])


def test_right(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert check("out", "--json") == 0
    assert json.loads(capsys.readouterr().out)["passed"]


def test_another_geometry(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    edit(project / "arm.urdf", "0.455", "0.460")
    assert check("out") == 1
    message = capsys.readouterr().err
    assert "by up to 5 mm and" in message
    assert "ikgen from-urdf arm.urdf" in message


def test_the_command_told_puts_it_right(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    import shlex

    edit(project / "arm.urdf", "0.455", "0.460")
    assert check("out") == 1
    hint = next(x for x in capsys.readouterr().err.splitlines() if x.startswith("hint: "))
    assert run([*shlex.split(hint.removeprefix("hint: "))[1:], "--no-verify"]) == 0
    assert check("out") == 0


def test_the_command_told_of_a_config_names_it_in_quotes(
    project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    config = project / "my arms" / "ikgen.toml"
    config.parent.mkdir()
    config.write_text('[[arm]]\nname = "arm"\nrobot = "../arm.urdf"\n')
    assert check("my arms/ikgen.toml") == 2
    shutil.copy("out/arm_ik.json", config.parent)
    assert check("my arms/ikgen.toml") == 1
    assert "hint: ikgen build 'my arms/ikgen.toml'\n" in capsys.readouterr().err


def test_text_changed_but_not_the_geometry(
    project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    edit(project / "arm.urdf", "</robot>", "<!-- a remark --></robot>")
    assert check("out") == 0
    assert ", 0 missed); arm.urdf has changed since" in capsys.readouterr().out


def test_limits_changed(project: Path) -> None:
    text = (project / "arm.urdf").read_text()
    start = text.index('lower="') + len('lower="')
    end = text.index('"', start)
    (project / "arm.urdf").write_text(text[:start] + "-1.0" + text[end:])
    assert check("out") == 1


def test_edited_output(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with (project / "out/arm_ik.py").open("a") as stream:
        stream.write("# a remark\n")
    assert check("out") == 1
    assert "was edited" in capsys.readouterr().err


def test_broken_output(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (project / "out/arm_ik.py").write_text("def (")
    assert check("out") == 1
    (project / "out/arm_ik.py").unlink()
    assert check("out") == 1
    assert "not there" in capsys.readouterr().err


def test_other_joints(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    edit(project / "arm.urdf", '"joint_a3"', '"elbow"')
    assert check("out") == 1
    assert "elbow" in capsys.readouterr().err


def test_a_tip_that_is_gone(project: Path) -> None:
    edit(project / "arm.urdf", '"tool0"', '"tool1"')
    assert check("out") == 1


def test_description_that_cannot_be_read(project: Path) -> None:
    (project / "arm.urdf").unlink()
    assert check("out") == 2
    (project / "out/arm_ik.json").write_text("{")
    assert check("out") == 2


def test_one_bad_record_leaves_the_others(
    project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    import junitparser

    shutil.copytree("out", "broken")
    (project / "broken/arm_ik.json").write_text("{")
    shutil.copytree("out", "orphan")
    edit(project / "orphan/arm_ik.json", "../arm.urdf", "../gone.urdf")
    assert check(".", "--json", "--junit-xml", "j.xml") == 2
    said = capsys.readouterr()
    assert "error: broken/arm_ik.json: not a record of ikgen" in said.err
    assert "error: gone.urdf: no such file" in said.err
    broken, orphan, right = json.loads(said.out)["outputs"]
    assert broken["robot"] is None and not broken["passed"] and not orphan["passed"]
    assert right["passed"] and right["verification"]["python"]["passed"]
    suites = junitparser.JUnitXml.fromfile("j.xml")
    assert suites.failures == 2
    cases = [(case.classname, case.name) for suite in suites for case in suite]
    assert len(cases) == len(set(cases))
    assert {"broken/arm.outputs", "orphan/arm.outputs", "out/arm.outputs"} <= {c for c, _ in cases}
    assert ("out/arm.outputs", "arm_ik.py up to date") in cases
    assert ("broken/arm.outputs", "arm_ik.json up to date") in cases


NO_TABLES = ("[]", "[1]", "null", "7", '"text"')
OTHER = '{"generator": "other"}'


@pytest.mark.parametrize("text", sampled([*NO_TABLES, "{}", OTHER], ["[1]", "{}", OTHER]))
def test_what_is_named_as_a_record_and_is_none_is_told(
    project: Path, text: str, capsys: pytest.CaptureFixture[str]
) -> None:
    (project / "out/other_ik.json").write_text(text)
    assert check("out", "--json") == 2
    said = capsys.readouterr()
    assert "error: out/other_ik.json: not a record of ikgen: the record " in said.err
    assert "for records alone" in said.err
    right, none = json.loads(said.out)["outputs"]
    assert right["passed"] and not none["passed"]


def test_a_record_of_another_generator_is_none(
    project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    edit(project / "out/arm_ik.json", '"generator": "ikgen"', '"generator": "other"')
    assert check("out") == 2
    assert "the record.generator: 'other' is not 'ikgen'" in capsys.readouterr().err


def test_a_table_without_numbers_is_not_passed(
    project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    table = KUKA.parent / "puma560_symbolic.toml"
    shutil.copy(table, project / "puma.toml")
    assert run(["from-dh", "puma.toml", "-o", "table", "--no-verify", "-q"]) == 0
    assert check(".") == 2
    said = capsys.readouterr()
    assert "arm: right (python 20 poses" in said.out and ": NOT CHECKED" in said.out
    assert "not checked: no numbers for a_2, d_3, a_3, d_4\n" in said.err
    assert "by the table's names, under [parameters] of puma.toml, then ikgen from-dh " in said.err
    with (project / "puma.toml").open("a") as stream:
        stream.write("# a remark\n")
    assert check("table") == 2
    assert "made from an earlier description" in capsys.readouterr().err


@needs_compiler
def test_a_header_that_does_not_compile(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    import junitparser

    options = ("--emit", "cpp", "--name", "arm", "--no-verify", "-q")
    assert run(["from-urdf", "arm.urdf", "-o", "header", *options]) == 0
    with (project / "header/arm_ik.hpp").open("a") as stream:
        stream.write("#error broken on purpose\n")
    assert check(".", "--junit-xml", "j.xml") == 1
    said = capsys.readouterr()
    assert "error: header/arm_ik.hpp: the emitted header does not compile" in said.err
    assert "arm: WRONG" in said.out and "arm: right (python" in said.out
    suites = junitparser.JUnitXml.fromfile("j.xml")
    (failed,) = (case for suite in suites for case in suite if case.is_failure)
    assert failed.name == "arm_ik.hpp up to date"
    assert "was edited after" in failed.result[0].message
    assert "the emitted header does not compile" in failed.result[0].message


def test_no_compiler_is_not_the_header_s_fault(
    project: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    options = ("--emit", "python,cpp", "--name", "arm", "--no-verify", "-q")
    assert run(["from-urdf", "arm.urdf", "-o", "out", *options]) == 0
    monkeypatch.setenv("CXX", "no-such-compiler")
    assert check("out", "--json") == 2
    said = capsys.readouterr()
    (output,) = json.loads(said.out)["outputs"]
    assert output["verification"]["python"]["passed"]
    assert "no-such-compiler is not a program" in output["findings"][0]["message"]


def test_another_robot(project: Path) -> None:
    shutil.copy(KUKA, project / "copy.urdf")
    (project / "arm.urdf").unlink()
    assert check("out", "--robot", "copy.urdf") == 0


def test_where_the_description_is_now_is_asked_for(
    project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (project / "arm.urdf").rename(project / "moved.urdf")
    assert check("out") == 2
    said = capsys.readouterr().err
    assert "arm.urdf: no such file" in said and "hint: ikgen verify out --robot FILE" in said


def test_the_command_that_replaces_outputs_of_another_robot_is_told(
    project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    other = KUKA.with_name("abb_irb2400.urdf")
    assert check("out", "--robot", str(other)) == 1
    (hint,) = (s for s in capsys.readouterr().err.splitlines() if s.startswith("hint: ikgen from"))
    assert run([*shlex.split(hint)[2:], "--no-verify"]) == 0
    assert check("out", "--robot", str(other)) == 0


def test_junit_and_annotations(
    project: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    import junitparser

    edit(project / "arm.urdf", "0.455", "0.460")
    monkeypatch.setenv("GITHUB_ACTIONS", "true")
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", str(project / "summary.md"))
    assert check("out", "--junit-xml", "results/j.xml") == 1
    assert "::error file=out/arm_ik.py,line=1::" in capsys.readouterr().err
    assert "WRONG" in (project / "summary.md").read_text()
    assert junitparser.JUnitXml.fromfile("results/j.xml").failures == 1


def test_module_entry() -> None:
    done = subprocess.run([sys.executable, "-m", "ikgen", "--version"], capture_output=True)
    assert done.returncode == 0


@needs_compiler
def test_outputs_of_an_earlier_run_are_not_passed_over(
    project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    again = ["from-urdf", "arm.urdf", "-o", "new", "--name", "arm", "--no-verify", "--emit"]
    assert run([*again, "cpp"]) == 0
    (project / "new/arm_ik.json").unlink()  # so that nothing tells that the header is kept
    assert run([*again, "python"]) == 0
    assert "arm_ik.hpp is of an earlier run" in capsys.readouterr().err
    assert check("new", "--json") == 1
    findings = json.loads(capsys.readouterr().out)["outputs"][0]["findings"]
    assert [Path(f["file"]).name for f in findings] == ["arm_ik.hpp"]
    (project / "new/arm_ik.hpp").write_text("// somebody's own")
    assert check("new") == 0


@pytest.mark.parametrize(
    ("emit", "gone"), [("python", "arm_ik.py"), ("cpp-package", "arm_ik_cpp/include/arm_ik.hpp")]
)
def test_a_file_that_is_gone_is_told_once(
    emit: str, gone: str, project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    options = ("--name", "arm", "--emit", emit, "--only", "--no-verify", "-q")
    assert run(["from-urdf", "arm.urdf", "-o", "out", *options]) == 0
    (project / "out" / gone).unlink()
    assert check("out") == 1
    told = [line for line in capsys.readouterr().err.splitlines() if ": " in line]
    assert told[0] == f"error: out/{gone}: is recorded but not there"
    assert [line.partition(": ")[0] for line in told] == ["error", "hint"]
