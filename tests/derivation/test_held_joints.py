"""Which joints are held where none were named: the ranking, and what is taken of it."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any

import pytest
from tests.support.redundant_arms import (
    NON_SPHERICAL_WRIST,
    SHOULDER_ELBOW_WRIST,
    TORSO,
    Joint,
    serial_urdf,
)
from tests.support.telescopes import telescope_robot

from ikgen.derivation.advice import attempts
from ikgen.derivation.derive import derive
from ikgen.derivation.held_joints import held_choices
from ikgen.derivation.progress import silent
from ikgen.derivation.read import read
from ikgen.elimination import elimination_plan
from ikgen.emit.derivation import Derivation
from ikgen.errors import UnsolvedChainError, VerificationError
from ikgen.generation.generate import generate
from ikgen.records.request import Outputs, Request
from ikgen.tasks import find_task
from ikgen.tasks.fitting import freedoms_moved

pytestmark = pytest.mark.usefixtures("solved_once")

ROOT = Path(__file__).resolve().parents[2]
FR3 = ROOT / "urdf_fixtures/franka_fr3.urdf"
TWO_ON_A_LINE = ROOT / "tests/robots/tables/Chair6DOF.toml"
POSE = find_task("pose")


def arm(folder: Path, *joints: Joint) -> Request:
    path = folder / "arm.urdf"
    path.write_text(serial_urdf("arm", joints))
    return Request(path)


def held(request: Request) -> list[tuple[str, ...]]:
    return [choice.held for choice in held_choices(read(request), POSE)]


def test_elbow_of_two_spherical_joints_is_never_held(tmp_path: Path) -> None:
    """With it the distance of the wrist from the shoulder would be fixed."""
    found = held(arm(tmp_path, *SHOULDER_ELBOW_WRIST))
    assert len(found) == 6 and ("elbow",) not in found
    assert found[0] == ("shoulder_roll",)  # the widest limits


def test_limits_decide_among_choices_of_one_class(tmp_path: Path) -> None:
    joints = [
        (*joint[:4], (-1.0, 1.0) if joint[0] == "shoulder_roll" else joint[4])
        for joint in SHOULDER_ELBOW_WRIST
    ]
    choices = held_choices(read(arm(tmp_path, *joints)), POSE)
    well = [choice.held for choice in choices if not choice.poor]
    assert len(well) > 2 and choices[0].held == well[0] and well[-1] == ("shoulder_roll",)


@pytest.mark.parametrize(("roll", "taken"), [(2.8, "shoulder_roll"), (2.5, "wrist_roll")])
def test_conditioning_decides_where_ranges_are_much_the_same(
    tmp_path: Path, roll: float, taken: str
) -> None:
    """Held, the wrist's roll leaves an arm conditioned half as well as the shoulder's does."""
    widths = {"shoulder_roll": roll, "wrist_roll": 3.05}
    joints = []
    for joint in SHOULDER_ELBOW_WRIST:
        width = widths.get(joint[0], 2.0)
        joints.append((*joint[:4], (-width, width)))
    reading = read(arm(tmp_path, *joints))
    first, *others = held_choices(reading, POSE)
    assert first.held == (taken,)
    wider = [one for one in others if one.span > first.span]
    assert [one.behind(first) for one in wider] == ["worse conditioned"] * (taken != "wrist_roll")


def test_an_elimination_that_is_slow_at_the_default_is_passed_over(tmp_path: Path) -> None:
    """With the lower arm's roll at 0 the axes of elbow and wrist meet: no resultant has separate roots."""
    request = arm(tmp_path, *NON_SPHERICAL_WRIST)
    first, second, *_ = held_choices(read(request), POSE)
    plans = [elimination_plan(choice.dh) for choice in (first, second)]
    assert [plan is not None and plan.steady for plan in plans] == [False, True]
    derivation = derive(request)
    assert derivation.held is not None and derivation.held.joints == second.held


def test_every_choice_leaves_the_task_to_do(tmp_path: Path) -> None:
    reading = read(arm(tmp_path, TORSO, *SHOULDER_ELBOW_WRIST))
    choices = held_choices(reading, POSE)
    assert all(len(choice.held) == 2 for choice in choices)
    assert all(freedoms_moved(choice.dh, POSE) == 6 for choice in choices[:5])
    keys = [choice.form for choice in choices]
    assert keys == sorted(keys) and keys[0] == 0


SNAKE_WRIST: tuple[Joint, ...] = (
    ("yaw", "revolute", "0 0 1", "0 0 0", (-1.5, 1.5)),
    ("pitch", "revolute", "0 1 0", "0 0 0", (-0.9, 0.9)),
    ("insertion", "prismatic", "1 0 0", "0 0 0", (0.05, 0.24)),
    ("roll", "revolute", "1 0 0", "0.1 0 0", (-2.2, 2.2)),
    ("near_pitch", "revolute", "0 1 0", "0 0 0", (-1.5, 1.5)),
    ("near_yaw", "revolute", "0 0 1", "0.0034 0 0", (-1.4, 1.4)),
    ("far_yaw", "revolute", "0 0 1", "0.0034 0 0", (-1.4, 1.4)),
    ("far_pitch", "revolute", "0 1 0", "0.0034 0 0", (-1.4, 1.4)),
)
"""An instrument whose insertion moves the tip far, and its wrist hardly."""


def test_a_simple_class_is_no_reason_to_hold_what_moves_the_tip_far(tmp_path: Path) -> None:
    request = arm(tmp_path, *SNAKE_WRIST)
    first, *others = held_choices(read(request), POSE)
    simple = next(choice for choice in others if choice.form < first.form)
    assert not first.feeble and "insertion" not in first.held and "insertion" in simple.held
    assert simple.feeble and simple.behind(first) == "worse conditioned"
    assert not first.behind(simple)
    derivation = derive(request)
    assert derivation.held is not None and "insertion" not in derivation.held.joints
    assert attempts(read(request), None, silent)[0].held == derivation.held.joints


def test_what_puts_a_choice_behind_is_its_class_first() -> None:
    choices = held_choices(read(Request(FR3)), find_task("pose"))
    reasons = {choice.words: choice.behind(choices[0]) for choice in choices[1:]}
    assert reasons["fr3_joint6"] == "a narrower range"
    assert reasons["fr3_joint4"] == "worse conditioned"
    assert reasons["fr3_joint5"] == "position apart from rotation, a quartic"
    assert choices[0].behind(choices[1]) == ""
    alike = dataclasses.replace(choices[0], condition=choices[0].condition / 2)
    assert alike.behind(choices[0]) == "worse conditioned"
    short = dataclasses.replace(choices[0], poor=True)  # of a volume that is small
    assert short.behind(choices[0]) == "less reach" and choices[0].behind(short) == ""
    assert choices[0].ranking.startswith(
        "class: position apart from rotation, two branches a step; "
    )


def test_nothing_is_held_where_no_joint_is_spare() -> None:
    assert held(Request(ROOT / "urdf_fixtures/abb_irb2400.urdf")) == []
    assert held(Request(FR3, free={"fr3_joint3": None})) == []
    assert held(Request(FR3, lock={"fr3_joint3": 0.0})) == []


def test_table_with_two_axes_on_one_line_holds_one_of_them() -> None:
    derivation = derive(Request(TWO_ON_A_LINE))
    assert derivation.held is not None
    assert set(derivation.held.joints) <= {"theta_5", "theta_6"}
    assert len(derivation.module.free_indices) == 1


def test_choice_is_explained_and_inspect_lists_it_first() -> None:
    derivation = derive(Request(FR3))
    assert derivation.held is not None
    assert derivation.held.joints == ("fr3_joint7",)
    assert derivation.held.words.startswith("holding fr3_joint7: closed form by rules (")
    assert all(step.branches <= 2 for step in derivation.graph.steps)
    assert derivation.module.free_indices == (6,)
    tried = attempts(read(Request(FR3)), None, silent)
    assert tried[0].held == derivation.held.joints and tried[0].closed
    assert [one.held for one in tried[1:]] == [("fr3_joint6",), ("fr3_joint4",)]
    steps = [" ".join(one.order) for one in tried]
    assert ["quartic" in text for text in steps] == [False, True, False]


def test_named_joint_wins_and_gives_the_same_module_as_the_choice() -> None:
    chosen, named = derive(Request(FR3)), derive(Request(FR3, free={"fr3_joint7": None}))
    assert named.held is None
    same = [
        dataclasses.replace(d.module, program=None, dh=None, plan=None) for d in (chosen, named)
    ]
    assert same[0] == same[1]
    assert chosen.graph.order == named.graph.order


def test_as_many_joints_are_held_as_a_smaller_task_leaves_over(tmp_path: Path) -> None:
    request = dataclasses.replace(arm(tmp_path, *SHOULDER_ELBOW_WRIST[:4]), task="position")
    derivation = derive(request)
    assert derivation.held is not None and len(derivation.held.joints) == 1
    assert derivation.task.name == "position"


def test_choice_that_fails_the_verification_is_passed_over(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    seen: list[tuple[str, ...]] = []

    def emitted(
        derivation: Derivation, *_: object
    ) -> tuple[dict[str, dict[str, str]], dict[str, object]]:
        assert derivation.held is not None
        seen.append(derivation.held.joints)
        if len(seen) == 1:
            raise VerificationError("wrong")
        return {}, {}

    monkeypatch.setattr("ikgen.generation.generate._emitted", emitted)
    request = arm(tmp_path, *SHOULDER_ELBOW_WRIST)
    held = generate(request, Outputs(out=tmp_path / "out")).derivation.held
    assert held is not None and held.joints == seen[1] != seen[0]
    assert held.refused == (seen[0],)
    assert held.words.endswith(f"; failed verification: {seen[0][0]}")
    named = dataclasses.replace(request, free={"shoulder_roll": None})
    seen.clear()
    monkeypatch.setattr("ikgen.generation.generate._emitted", refuse)
    with pytest.raises(VerificationError):
        generate(named, Outputs(out=tmp_path / "out"))


def test_where_every_choice_fails_the_verification_that_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Two joints on one line leave two choices; with none of the two held no chain is derived."""
    seen: list[tuple[str, ...]] = []

    def emitted(derivation: Derivation, *_: object) -> None:
        assert derivation.held is not None
        seen.append(derivation.held.joints)
        raise VerificationError("wrong")

    monkeypatch.setattr("ikgen.generation.generate._emitted", emitted)
    with pytest.raises(VerificationError, match="wrong"):
        generate(Request(TWO_ON_A_LINE, task="pose"), Outputs(out=tmp_path))
    assert sorted(seen) == [("theta_5",), ("theta_6",)]


def test_a_choice_that_fails_is_told_where_no_other_is_solved(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def derived(*arguments: Any) -> Derivation:
        if arguments[-1]:
            raise UnsolvedChainError("no closed form")
        return derive(*arguments)

    monkeypatch.setattr("ikgen.generation.generate.derive", derived)
    monkeypatch.setattr("ikgen.generation.generate._emitted", refuse)
    with pytest.raises(VerificationError, match="wrong"):
        generate(Request(TWO_ON_A_LINE), Outputs(out=tmp_path))


def refuse(*_: object) -> None:
    raise VerificationError("wrong")


def test_slide_is_held_where_no_axes_are_special(tmp_path: Path) -> None:
    """What moves then is six revolute joints, which the elimination solves."""
    skew = [
        (f"joint_{k}", "revolute", axis, f"0.{k + 1} 0.0{9 - k} 0.1{k}", (-2.5, 2.5))
        for k, axis in enumerate(("0 0 1", "1 2 0", "0 1 3", "2 0 1", "1 1 1", "0 3 1", "1 0 2"))
    ]
    choices = held_choices(read(arm(tmp_path, TORSO, *skew)), POSE)
    assert all("torso" in choice.held for choice in choices[:7])
    assert all("torso" not in choice.held for choice in choices[7:])


def test_slides_and_the_tool_measure_an_arm_without_links(tmp_path: Path) -> None:
    reading = read(Request(telescope_robot(tmp_path), task="position"))
    choices = held_choices(reading, find_task("position"))
    assert choices[0].held == ("pitch",) and all(len(choice.held) == 1 for choice in choices)


@pytest.mark.parametrize("robot", ["ur5e", "kuka_kr6r900sixx"])
def test_a_position_is_reached_by_what_carries_the_tool_far(robot: str) -> None:
    """A wrist alone moves the tool by some centimetres, however wide the ranges of what it leaves held."""
    derivation = derive(Request(ROOT / f"urdf_fixtures/{robot}.urdf", task="position"))
    dh = derivation.reading.dh
    names = [joint.name for joint in dh.joints]
    assert sorted(names.index(name) for name in dh.free) == [3, 4, 5]
