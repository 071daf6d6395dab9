"""What runs in CI: the action's script, the GitLab job, the commit hooks, the published schema."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import junitparser
import pytest

from ikgen.cli.main import run
from ikgen.projects.proofs import _wrong

pytestmark = pytest.mark.usefixtures("solved_once")

jsonschema = pytest.importorskip("jsonschema")
yaml = pytest.importorskip("yaml")
ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs/how-to/ci.md").read_text()
SCHEMA = json.loads((ROOT / "docs/reference/verify.schema.json").read_text())
CONFIG = """
[[arm]]
name = "arm"
robot = "elbow.urdf"
task = "position"
out = "generated"
samples = 20
"""


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A repository with a config, a robot and its outputs (unverified), as the current directory."""
    shutil.copy(ROOT / "examples/setuptools_robot/urdf/elbow.urdf", tmp_path)
    (tmp_path / "ikgen.toml").write_text(CONFIG)
    monkeypatch.chdir(tmp_path)
    for name in ("GITHUB_ACTIONS", "GITHUB_STEP_SUMMARY", "GITHUB_WORKSPACE"):
        monkeypatch.delenv(name, raising=False)
    assert run(["build", "--no-verify", "-q"]) == 0
    return tmp_path


def lengthen(package: Path) -> None:
    """Make the upper arm a millimetre longer."""
    robot = package / "elbow.urdf"
    text = robot.read_text()
    assert "0 0 0.35" in text
    robot.write_text(text.replace("0 0 0.35", "0 0 0.351"))


def shell(script: str, cwd: Path, **variables: str) -> subprocess.CompletedProcess[str]:
    """Run a script as a runner's `shell: bash` does, with ikgen on PATH."""
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    (cwd / ".step.sh").write_text(script)
    return subprocess.run(
        ["bash", "--noprofile", "--norc", "-eo", "pipefail", ".step.sh"],
        cwd=cwd,
        env={"PATH": path, "HOME": str(cwd), "CI": "true", **variables},
        text=True,
        capture_output=True,
    )


def action(package: Path, **inputs: str) -> subprocess.CompletedProcess[str]:
    """The Verify step of action.yml, with its inputs filled in as a runner does."""
    described = yaml.safe_load((ROOT / "action.yml").read_text())
    given = {name: spec["default"] for name, spec in described["inputs"].items()} | {
        name.replace("_", "-"): value for name, value in inputs.items()
    }
    (step,) = (s for s in described["runs"]["steps"] if s.get("name") == "Verify")
    assert step["shell"] == "bash"
    filled = {
        name: re.sub(r"\$\{\{ inputs\.([\w-]+) \}\}", lambda m: given[m.group(1)], value)
        for name, value in step["env"].items()
    }
    return shell(
        step["run"],
        package,
        GITHUB_ACTIONS="true",
        GITHUB_WORKSPACE=str(package),
        GITHUB_STEP_SUMMARY=str(package / "summary.md"),
        **filled,
    )


def test_the_action_passes_right_outputs(package: Path) -> None:
    done = action(package)
    assert done.returncode == 0, done.stderr
    assert "| arm | python | 1000 |" in (package / "summary.md").read_text()
    assert "::error" not in done.stderr


def test_the_action_fails_on_another_geometry(package: Path) -> None:
    lengthen(package)
    done = action(package, samples="20", target="ikgen.toml", junit_xml="out/ik.xml")
    assert done.returncode == 1
    (annotation,) = (x for x in done.stderr.splitlines() if x.startswith("::error"))
    assert annotation.startswith("::error file=generated/arm_ik.py,line=1::made from another")
    assert "1 mm and 0 rad. Run: ikgen build ikgen.toml" in annotation
    summary = (package / "summary.md").read_text()
    assert "WRONG" in summary and "Run `ikgen build ikgen.toml`" in summary
    assert junitparser.JUnitXml.fromfile(str(package / "out/ik.xml")).failures == 1


def test_the_action_points_at_what_cannot_be_read(package: Path) -> None:
    robot = package / "elbow.urdf"
    robot.write_text(robot.read_text().replace("</robot>", ""))
    done = action(package, samples="20")
    assert done.returncode == 2
    assert re.search(r"^::error file=elbow\.urdf,line=\d+::", done.stderr, re.M), done.stderr
    assert "could not check" in (package / "summary.md").read_text()


def test_what_no_command_puts_right_is_told_in_words(package: Path) -> None:
    module = package / "generated/arm_ik.py"
    module.with_suffix(".hpp").write_text(module.read_text())
    done = action(package, samples="20")
    assert done.returncode == 1
    (annotation,) = (x for x in done.stderr.splitlines() if x.startswith("::error"))
    assert (
        "nothing keeps it right. remove it, or generate" in annotation and "Run" not in annotation
    )
    assert "WRONG: is of an earlier run" in (package / "summary.md").read_text()
    assert "Run `" not in (package / "summary.md").read_text()


def test_a_derivation_that_does_not_hold_has_no_command_to_run() -> None:
    wrong = SimpleNamespace(label="equation 1", reason="0 = 1", wrong=True)
    proof = SimpleNamespace(equations=(wrong,), patterns=())
    (finding,) = _wrong(cast(Any, proof), Path("arm.ikgen.json"))
    assert (finding.command, finding.remedy) == ("", "please report it")


def test_annotations_are_relative_to_the_checkout(
    package: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    lengthen(package)
    monkeypatch.setenv("GITHUB_ACTIONS", "true")
    monkeypatch.setenv("GITHUB_WORKSPACE", str(package.parent))
    assert run(["verify", "--samples", "20", "-q"]) == 1
    assert f"file={package.name}/generated/arm_ik.py" in capsys.readouterr().err


def test_the_gitlab_job(package: Path) -> None:
    (text,) = re.findall(r'^```yaml title="\.gitlab-ci\.yml"\n(.*?)^```', PAGE, re.M | re.S)
    job = yaml.safe_load(text)["inverse-kinematics"]
    script = "\n".join(line for line in job["script"] if not line.startswith("pip"))
    assert run(["build", "-q"]) == 0
    done = shell(script, package)
    assert done.returncode == 0, done.stderr
    assert (package / job["artifacts"]["reports"]["junit"]).is_file()
    lengthen(package)
    done = shell(script, package)
    assert (
        done.returncode == 1 and ": WRONG; " in done.stdout and " has changed since" in done.stdout
    )


def test_the_json_follows_its_schema(package: Path, capsys: pytest.CaptureFixture[str]) -> None:
    validator = jsonschema.Draft202012Validator(SCHEMA)
    validator.check_schema(SCHEMA)
    assert run(["verify", "--samples", "20", "--json"]) == 0
    right = json.loads(capsys.readouterr().out)
    validator.validate(right)
    lengthen(package)
    assert run(["verify", "--samples", "20", "--json"]) == 1
    wrong = json.loads(capsys.readouterr().out)
    validator.validate(wrong)
    (finding,) = wrong["outputs"][0]["findings"]
    assert finding["deviation"] == {"m": pytest.approx(1e-3), "rad": 0.0}
    (package / "generated/arm_ik.py").unlink()
    assert run(["verify", "--json"]) == 1
    validator.validate(json.loads(capsys.readouterr().out))
    del right["outputs"][0]["record"]
    assert not validator.is_valid(right)


def hooks() -> dict[str, dict[str, object]]:
    return {h["id"]: h for h in yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text())}


def test_the_check_hook_needs_the_standard_library_alone(package: Path) -> None:
    hook = hooks()["ikgen-check"]
    assert hook["language"] == "script"
    command = [getattr(sys, "_base_executable", sys.executable), "-S", ROOT / str(hook["entry"])]

    def check(*arguments: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run([*command, *arguments], text=True, capture_output=True)

    if sys.version_info < (3, 11):
        pytest.skip("tomllib is in the standard library from Python 3.11 on")
    assert run(["build", "-q"]) == 0
    assert check().stdout == "arm: up to date\n"
    lengthen(package)
    done = check("ikgen.toml")
    assert done.returncode == 1 and "elbow.urdf has changed" in done.stdout
    assert done.stderr == "hint: ikgen build ikgen.toml\n"
    done = check("nothing.toml")
    assert done.returncode == 2 and "no such file" in done.stderr


@pytest.mark.parametrize("hook", ["ikgen-check", "ikgen-verify"])
def test_hooks_run_whatever_was_changed(hook: str) -> None:
    described = hooks()[hook]
    assert described["always_run"] is True and described["pass_filenames"] is False
    assert not {"files", "types", "exclude"} & set(described)


def test_the_verify_hook_runs(package: Path) -> None:
    entry = str(hooks()["ikgen-verify"]["entry"])
    assert shell(entry, package).returncode == 0
    lengthen(package)
    assert shell(entry, package).returncode == 1


@pytest.mark.skipif(
    shutil.which("pre-commit") is None
    or shutil.which("git") is None
    or not (ROOT / ".git").exists(),
    reason="needs pre-commit, git and a checkout",
)
def test_pre_commit_runs_the_check_hook(package: Path) -> None:
    assert run(["build", "-q"]) == 0
    for command in ("git init -q", "git add ."):
        assert shell(command, package).returncode == 0
    tried = f"pre-commit try-repo '{ROOT}' ikgen-check --all-files"
    done = shell(tried, package)
    assert done.returncode == 0, done.stdout + done.stderr
    lengthen(package)
    done = shell(tried, package)
    assert (
        done.returncode == 1 and ": WRONG; " in done.stdout and " has changed since" in done.stdout
    )


def test_build_check_imports_nothing_heavy(package: Path) -> None:
    code = (
        "import sys\nfrom ikgen.cli.main import run\nrun(['build', '--check'])\n"
        "print([m for m in ('numpy', 'sympy', 'pinocchio', 'xacro', 'jinja2',"
        " 'py_trees', 'lxml', 'rich') if m in sys.modules])"
    )
    for change in (lambda _: None, lengthen):
        change(package)
        done = subprocess.run([sys.executable, "-c", code], text=True, capture_output=True)
        assert done.stdout.endswith("[]\n"), done.stdout + done.stderr
