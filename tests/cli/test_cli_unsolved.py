"""Unsolved is an answer: exit code 3, what is left, what came nearest, and advice that was tried."""

from __future__ import annotations

import itertools
import re
import shlex
from pathlib import Path

import pytest

from ikgen.cli.main import run
from ikgen.errors import UnsolvedChainError
from ikgen.generation.derive import derive
from ikgen.generation.remedies import remedies
from ikgen.generation.request import Request
from ikgen.solver.remainder import near_misses, open_equations

ROOT = Path(__file__).resolve().parents[2]
TWO_ON_A_LINE = ROOT / "tests" / "robots" / "tables" / "Chair6DOF.toml"
SEVEN = ROOT / "urdf_fixtures" / "franka_fr3.urdf"

ROWS = (
    (0, 0, 0.3), (0.7, 0.11, 0.07), (-1.1, 0.43, 0.05), (0.45, 0.37, 0.12), (1.3, 0.09, 0.21),
)  # fmt: skip
PRISMATIC = '[[joints]]\ntype = "prismatic"\nalpha = 0.8\na = 0.15\ntheta = 0.3\n'


@pytest.fixture
def general(tmp_path: Path) -> Path:
    """Five revolute joints without any special geometry."""
    rows = [
        f'[[joints]]\ntype = "revolute"\nalpha = {alpha}\na = {a}\nd = {d}\n'
        for alpha, a, d in ROWS
    ]
    path = tmp_path / "general.toml"
    path.write_text('name = "general"\nconvention = "modified"\n' + "".join(rows))
    return path


def hinted(text: str) -> list[list[str]]:
    """The options of each closed form that the hint names."""
    hint = text[text.index("\nhint: ") :]
    assert "closed forms were found with: " in hint, hint
    listing = hint.split("closed forms were found with: ")[1].split("; --lock")[0]
    return [shlex.split(re.sub(r"\(.*?\)", "", part)) for part in listing.strip().split("; ")]


def test_general_five_joints(
    general: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    assert run(["from-dh", str(general), "--task", "pose", "-o", str(out)]) == 3
    assert not out.exists()
    said = capsys.readouterr().err
    cause = "5 joints move and the task fixes 6 freedoms: more than the arm can do"
    assert f"error: no closed form found for the task 'pose': {cause}\nhint: ikgen from-dh " in said
    assert "equations" not in said
    assert run(["from-dh", str(general), "--task", "pose", "-o", str(out), "-v"]) == 3
    told = capsys.readouterr().err
    assert "behaviour tree:" in told and "solved nothing; left are" in told
    assert re.search(r"\d+ equations are left; the shortest", told)
    assert re.search(r"\n  \(\d,\d\) r33: .* = .*\n", told)
    assert re.search(r"nearest: sine and cosine for theta_\d from .* which lacks theta_\d", told)
    options = hinted(said)[0]
    assert run(["from-dh", str(general), *options, "-o", str(out), "--no-verify", "-q"]) == 0


def test_unsolved_with_a_prismatic_joint_says_what_was_tried(
    general: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    general.write_text(general.read_text() + PRISMATIC)
    assert run(["from-dh", str(general), "-o", str(tmp_path / "out")]) == 3
    said = capsys.readouterr().err
    assert "tried without success: --task position-direction with d_6, or" in said


def test_how_much_is_tried_does_not_depend_on_the_time(
    general: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with pytest.raises(UnsolvedChainError) as caught:
        derive(Request(general, task="pose"))
    clock = itertools.count(step=1000.0)  # a machine on which everything takes ages
    monkeypatch.setattr("time.monotonic", lambda: next(clock))
    tried = remedies(caught.value.unsolved, lambda *_: None)
    assert len([a for a in tried if a.closed]) == 3
    monkeypatch.setattr("ikgen.generation.remedies.ATTEMPTS", 2)
    assert remedies(caught.value.unsolved, lambda *_: None) == tried[:2]


def test_seven_joints_are_told_which_to_hold(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["from-urdf", str(SEVEN), "--no-verify"]) == 3
    options = hinted(capsys.readouterr().err)
    assert ["--free", "fr3_joint7"] in options


def test_axes_on_one_line_are_told_which_to_hold(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["from-dh", str(TWO_ON_A_LINE), "-v"]) == 3
    said = capsys.readouterr().err
    held = [["--free", name, "--task", "pose"] for name in ("theta_6", "theta_5")]
    assert hinted(said) == held
    assert "the joints 'theta_5' and 'theta_6' turn about one line" in said
    assert "solved d_1 (algebraic)" in said and "r_31*c_6 - r_32*s_6" in said
    assert "which lacks theta_5" in said


def test_shortest_equations_come_first() -> None:
    with pytest.raises(UnsolvedChainError) as caught:
        derive(Request(TWO_ON_A_LINE))
    graph = caught.value.unsolved.graph
    left = open_equations(graph, lambda side: len(side.args))
    assert [o.rank for o in left] == sorted(o.rank for o in left)
    near = near_misses(left)[0]
    assert {near.unknown.text, *(v.text for v in near.lacking)} == {"theta_5", "theta_6"}


def test_report_of_an_unsolved_arm(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["report", str(TWO_ON_A_LINE), "-o", str(tmp_path)]) == 3
    html = (tmp_path / "chair6dof_report.html").read_text(encoding="utf-8")
    for words in (
        "What is left",
        "The leaves that came nearest",
        "What would help",
        "--free theta_6",
    ):
        assert words in html
    assert "1. " in html and "algebraic" in html  # what was solved
    assert (tmp_path / "chair6dof_report.tex").is_file()
    assert "No closed form was found." in html and "Sets of joint solutions" not in html
