"""Unsolved is an answer: exit code 3, what is left, what came nearest, and advice that was tried."""

from __future__ import annotations

import itertools
import re
import shlex
from pathlib import Path

import pytest

from ikgen.cli.main import run
from ikgen.derivation.derive import derive
from ikgen.derivation.read import read
from ikgen.derivation.remedies import remedies
from ikgen.emit.derivation import Unsolved
from ikgen.errors import UnsolvedChainError
from ikgen.kinematics.classify import classify
from ikgen.records.request import Request
from ikgen.report import emit_unsolved
from ikgen.solver import solve
from ikgen.solver.remainder import near_misses, open_equations
from ikgen.tasks import find_task

pytestmark = pytest.mark.usefixtures("solved_once")

ROOT = Path(__file__).resolve().parents[2]
TWO_ON_A_LINE = ROOT / "tests" / "robots" / "tables" / "Chair6DOF.toml"

ROWS = (
    (0, 0, 0.3), (0.7, 0.11, 0.07), (-1.1, 0.43, 0.05), (0.45, 0.37, 0.12), (1.3, 0.09, 0.21),
)  # fmt: skip
PRISMATIC = '[[joints]]\ntype = "prismatic"\nalpha = 0.8\na = 0.15\ntheta = 0.3\n'
ON_THE_SAME_LINE = '[[joints]]\ntype = "revolute"\nalpha = 0\na = 0\nd = 0.2\n'


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
    own = (
        r"without a task that is asked for the arm gets 'position-direction(:[xy])?' \(at most 16 "
    )
    assert re.search(rf"\nhint: ikgen from-dh \S*general.toml\n      {own}", said)
    assert run(["from-dh", str(general), "--task", "pose", "-o", str(out), "-v"]) == 3
    told = capsys.readouterr().err
    assert "behavior tree:" in told and "solved nothing; left are" in told
    assert re.search(r"\d+ equations are left; the shortest", told)
    assert re.search(r"\n  \(\d,\d\) r33: .* = .*\n", told)
    assert re.search(r"nearest: sine and cosine for theta_\d from .* which lacks theta_\d", told)
    options = hinted(said)[0]
    assert run(["from-dh", str(general), *options, "-o", str(out), "--no-verify", "-q"]) == 0


def test_unsolved_with_a_prismatic_joint_is_told_what_helps(
    general: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rows = general.read_text().rsplit("[[joints]]", 1)[0]
    general.write_text(rows + PRISMATIC)
    out = tmp_path / "out"
    assert run(["from-dh", str(general), "--task", "pose", "-o", str(out)]) == 3
    options = hinted(capsys.readouterr().err)[0]
    assert "d_5" in options
    assert run(["from-dh", str(general), *options, "-o", str(out), "--no-verify", "-q"]) == 0


def test_how_much_is_tried_does_not_depend_on_the_time(
    general: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with pytest.raises(UnsolvedChainError) as caught:
        derive(Request(general, task="pose"))
    clock = itertools.count(step=1000.0)  # a machine on which everything takes ages
    monkeypatch.setattr("time.monotonic", lambda: next(clock))
    tried = remedies(caught.value.unsolved, lambda *_: None)
    assert len([a for a in tried if a.closed]) == 3
    monkeypatch.setattr("ikgen.derivation.remedies.ATTEMPTS", 2)
    assert remedies(caught.value.unsolved, lambda *_: None) == tried[:2]


@pytest.mark.long
def test_seven_joints_that_no_choice_solves(
    general: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Two of its axes lie on one line; five joints without special geometry are left of any choice, and
    cannot take a whole pose."""
    general.write_text(general.read_text() + ON_THE_SAME_LINE)
    out = tmp_path / "out"
    assert run(["from-dh", str(general), "--task", "pose", "-o", str(out)]) == 3
    said = capsys.readouterr().err
    assert "turn about one line, so that every pose has infinitely many solutions" in said
    assert not out.exists()


PARALLELOGRAM = """<robot name="palletizer">
  <link name="base"/><link name="a"/><link name="b"/><link name="c"/><link name="d"/><link name="e"/>
  <link name="f"/>
  <joint name="turn" type="continuous"><parent link="base"/><child link="a"/><axis xyz="0 0 1"/></joint>
  <joint name="lower" type="continuous"><parent link="a"/><child link="b"/><origin xyz="0.3 0 0.7"/>
    <axis xyz="0 1 0"/></joint>
  <joint name="upper" type="continuous"><parent link="b"/><child link="c"/><origin xyz="0 0 1.1"/>
    <axis xyz="0 1 0"/></joint>
  <joint name="rod1" type="continuous"><parent link="c"/><child link="d"/><origin xyz="1.2 0 0"/>
    <axis xyz="0 1 0"/><mimic joint="upper" multiplier="-1"/></joint>
  <joint name="rod2" type="continuous"><parent link="d"/><child link="e"/><axis xyz="0 1 0"/>
    <mimic joint="lower" multiplier="-1"/></joint>
  <joint name="roll" type="continuous"><parent link="e"/><child link="f"/>
    <origin xyz="0.2 0 -0.3" rpy="3.14159 0 0"/><axis xyz="0 0 1"/></joint>
</robot>
"""


def test_rods_of_a_parallelogram_on_one_line_are_no_continuum(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Both follow joints elsewhere: what is told is that the tool cannot be raised."""
    path = tmp_path / "palletizer.urdf"
    path.write_text(PARALLELOGRAM)
    monkeypatch.setattr("ikgen.verify.motion_checks._MOTIONS", 1)  # none can be followed
    assert (
        run(["from-urdf", str(path), "--task", "position-pitch:y", "-o", str(tmp_path / "out")])
        == 3
    )
    said = capsys.readouterr().err
    assert "the joints move 3 of the 4 freedoms that the task fixes" in said
    assert "one line" not in said


def test_axes_on_one_line_need_no_option(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = ["from-dh", str(TWO_ON_A_LINE), "-o", str(tmp_path), "--no-verify"]
    assert run(arguments) == 0
    said = capsys.readouterr().err
    assert re.search(r"(?m)^holding theta_[56]: the general 5R1P elimination", said)


def two_on_a_line() -> Unsolved:
    """What is left of the table with both of the joints moving."""
    reading = read(Request(TWO_ON_A_LINE))
    dh = reading.dh
    return Unsolved(
        reading,
        classify(dh),
        find_task("pose"),
        solve.solve_chain(dh),
        "chair6dof",
        "Chair6DOF.toml",
        "ikgen report Chair6DOF.toml",
    )


def test_shortest_equations_come_first() -> None:
    found = two_on_a_line()
    left = open_equations(found.graph, lambda side: len(side.args))
    assert [o.rank for o in left] == sorted(o.rank for o in left)
    near = near_misses(left)[0]
    assert {near.unknown.text, *(v.text for v in near.lacking)} == {"theta_5", "theta_6"}


def test_report_of_what_is_left() -> None:
    texts = emit_unsolved(two_on_a_line(), "hold one of them")
    html = texts["chair6dof_report.html"]
    for words in (
        "What is left",
        "The leaves that came nearest",
        "What would help",
        "Hold one of them.",
    ):
        assert words in html
    assert "1. " in html and "algebraic" in html  # what was solved
    assert "no closed form was found" in html and "Sets of joint solutions" not in html


def test_report_of_an_unsolved_arm(
    general: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["report", str(general), "--task", "pose", "-o", str(tmp_path)]) == 3
    html = (tmp_path / "general_report.html").read_text(encoding="utf-8")
    assert "What would help" in html and "--task position" in html
    assert (tmp_path / "general_report.tex").is_file()
    assert "no closed form was found" in html and "Sets of joint solutions" not in html
