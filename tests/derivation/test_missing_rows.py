"""What is said of a form that was known to miss rows, and that its verification refused."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest
from tests.support.solving import FIXTURES

import ikgen
from ikgen.derivation.derive import derive
from ikgen.derivation.unsolved import _OF_MISSING_ROWS, incomplete_error
from ikgen.emit.derivation import Derivation
from ikgen.errors import IkgenError, UnsolvedChainError, VerificationError
from ikgen.generation.generate import generate
from ikgen.records.request import Outputs, Request
from ikgen.verify.verification_report import CheckResult, VerificationReport

pytestmark = pytest.mark.usefixtures("solved_once")

REQUEST = Request(FIXTURES / "puma560_paper.toml")


@pytest.fixture(scope="module")
def derivation() -> Derivation:
    return derive(REQUEST)


def said(derivation: Derivation, *failed: str) -> IkgenError:
    checks = tuple(CheckResult(name, False, 9, 2, worst_case="random #3") for name in failed)
    report = VerificationReport("python", "a", "b", "pose", 9, 0, checks)
    error = VerificationError("wrong", reports={"python": report}, derivation=derivation)
    return incomplete_error(error, REQUEST)


def weak(derivation: Derivation) -> Derivation:
    first, *steps = derivation.graph.steps
    graph = replace(derivation.graph, steps=(replace(first, sound=False), *steps))
    return replace(derivation, graph=graph)


def test_a_weak_step_that_misses_rows_is_no_closed_form(derivation: Derivation) -> None:
    found = said(weak(derivation), "completeness", "poses answered")
    assert isinstance(found, UnsolvedChainError) and found.exit_code == 3
    first = derivation.graph.steps[0].candidate
    assert f"{first.unknown.text} ({first.leaf}) fails" in found.message
    assert "2 of 9 wrong" in found.details[0] and "--free JOINT" in found.hint
    assert found.unsolved.task is derivation.task


def test_wrong_rows_and_misses_that_nothing_told_of_are_failures(derivation: Derivation) -> None:
    for made, failed in (
        (derivation, ("completeness",)),
        (weak(derivation), ("completeness", "closure")),
        (weak(derivation), ()),
    ):
        found = said(made, *failed)
        assert isinstance(found, VerificationError) and found.exit_code == 1


def test_each_check_is_of_missing_rows_or_of_wrong_code(
    derivation: Derivation, tmp_path: Path
) -> None:
    made = generate(REQUEST, Outputs(out=tmp_path, samples=20))
    names = {check.name for report in made.reports.values() for check in report.checks}
    names |= {"runs", "self motion", "agreement with cpp"}
    told = {name for name in names if isinstance(said(weak(derivation), name), UnsolvedChainError)}
    told = {name.partition(" with ")[0] for name in told}
    assert told == _OF_MISSING_ROWS
    assert {"closure", "runs", "bad shapes", "invalid poses", "determinism", "seed order"} <= names
    found = said(weak(derivation), "completeness", "bad shapes")
    assert isinstance(found, VerificationError)


def test_an_elimination_that_misses_some_is_named(derivation: Derivation) -> None:
    for recall, kind in ((0.985, UnsolvedChainError), (1.0, VerificationError)):
        plan = SimpleNamespace(recall=recall)
        module = SimpleNamespace(plan=plan, name="made")
        found = said(replace(derivation, module=module), "completeness")  # type: ignore[arg-type]
        assert isinstance(found, kind)
        assert "98.5% of them" in found.message or kind is VerificationError


@pytest.mark.parametrize("ratio", ["5", "-180"])
def test_rows_of_joints_that_turn_many_times_as_far_are_checked(tmp_path: Path, ratio: str) -> None:
    """The guard of each row compared nothing, as multiples of an angle above the second were not known."""
    text = (FIXTURES / "kuka_kr6r900sixx.urdf").read_text("utf-8")
    joint = '<joint name="joint_a2" type="revolute">'
    mimic = f'<mimic joint="joint_a3" multiplier="{ratio}"/>'
    path = tmp_path / "fast.urdf"
    path.write_text(text.replace(joint, joint + mimic), "utf-8")
    arm = ikgen.load(path, base="base_link", tip="tool0")
    assert arm.verification is not None and arm.joint_names[1] == "joint_a3"
