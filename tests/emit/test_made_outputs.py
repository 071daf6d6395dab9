"""What emitters say of a module made by hand: joints, limits, what is held, which headers it takes."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from tests.support.made_programs import made_module, with_limits

from ikgen.elimination.parallel_plans import ParallelKind
from ikgen.emit import moveit
from ikgen.emit.blanks import blank_functions
from ikgen.emit.cpp.cpp_emitter import (
    _depth_first,
    _elimination,
    _far_limits,
    _headers,
    _rough,
    emit_header,
)
from ikgen.emit.cpp.cpp_language import number
from ikgen.emit.cpp.cpp_twist_chain import twist_lines
from ikgen.emit.derivation import Held
from ikgen.emit.python.python_emitter import _held_name, _held_turns
from ikgen.emit.solver_module import SolverModule, most_rows
from ikgen.emit.twist_numbers import twist_numbers
from ikgen.errors import UsageError
from ikgen.kinematics.twist_links import twist_chain
from ikgen.model.angle_function import cosine_and_sine
from ikgen.model.dh import ARM_ANGLE_OPTION, Angle, DHRow
from ikgen.program.policy import SolvePolicy
from ikgen.program.routines import GENERAL_6R

PI, INF = math.pi, math.inf
EVERY = (-INF, INF)


def holding(*free: str) -> SolverModule:
    module = made_module()
    return replace(module, dh=replace(module.dh, free=free))


@pytest.mark.parametrize(
    ("free", "name", "turns"),
    [
        ((), "", False), (("q0",), "q0", True), (("q2",), "q2", False), (("q1", "q2"), "q1", True),
        ((ARM_ANGLE_OPTION,), "the arm angle", False), (("q2", ARM_ANGLE_OPTION), "q2", False),
    ],
)  # fmt: skip
def test_what_is_held_first_has_a_name(free: tuple[str, ...], name: str, turns: bool) -> None:
    module = holding(*free)
    assert _held_name(module) == name and _held_turns(module) is turns


def test_braced_lists_hold_the_chain() -> None:
    module = made_module()
    chain, text = twist_chain(module.dh), twist_lines(module)

    def values(line: str) -> list[float]:
        assert line.startswith("{") and line.endswith("}")
        return [float({"true": 1, "false": 0}.get(part, part)) for part in line[1:-1].split(", ")]

    for lines, frame in ((text.first, chain.first), (text.last, chain.last)):
        np.testing.assert_array_equal([values(line) for line in lines], frame[:3])
    assert len(text.links) == len(chain.links) == 3
    for line, link in zip(text.links, chain.links, strict=True):
        driver, revolute, scale, offset, ct, st, x, y, c, s = values(line)
        assert (driver, bool(revolute)) == (link.driver, link.revolute)
        assert (scale, offset, x, y) == (link.scale, link.offset, link.x, link.y)
        assert (ct, st) == pytest.approx((math.cos(link.turn), math.sin(link.turn)), abs=1e-15)
        assert (c, s) == pytest.approx((math.cos(link.twist), math.sin(link.twist)), abs=1e-15)


def test_links_that_follow_the_joints_one_by_one_are_direct() -> None:
    module = made_module()
    rows = module.dh.rows

    def direct(*rows: DHRow) -> bool:
        return twist_numbers(replace(module, dh=replace(module.dh, rows=rows)), repr).direct

    assert direct(*rows)
    assert not direct(replace(rows[0], scale=-1.0), *rows[1:])
    assert not direct(rows[1], rows[0], rows[2])
    assert not direct(*rows[:2], replace(rows[2], driver=1))


def planned(
    *, bounded: bool | None, kind: ParallelKind = ParallelKind.UPRIGHT, turning: bool = True
) -> SimpleNamespace:
    """A plan with an elimination about parallel axes, whose polynomial is `bounded` or not, or without."""
    parallel = None if bounded is None else SimpleNamespace(loop=(0, 0), kind=kind, bounded=bounded)
    return SimpleNamespace(parallel=parallel, turning=(True, turning), tool=None)


@pytest.mark.parametrize("bounded", [None, False, True])
def test_the_elimination_about_parallel_axes_comes_with_its_header(bounded: bool | None) -> None:
    module = made_module()
    call = replace(module.program.levels[2].call, routine=GENERAL_6R)
    level = replace(module.program.levels[2], call=call)
    program = replace(module.program, levels=(*module.program.levels[:2], level))
    for kind, name in zip(ParallelKind, ("kPlain", "kUpright", "kMeeting"), strict=True):
        planned_one = replace(module, program=program, plan=planned(bounded=bounded, kind=kind))
        found = _headers(planned_one)
        assert ("elimination/parallel_6r.hpp" in found) == bool(bounded)
        assert found[:4] == [
            "arrays/lane_angle.hpp", "solving/single_solve.hpp",
            "roots/routine_roots.hpp", "elimination/general_6r_arm.hpp",
        ]  # fmt: skip
        told = _elimination(planned_one)
        assert told == {
            "routine": "general_6r", "elimination": "Parallel6r" if bounded else "General6r",
            "parallel_kind": name if bounded else "", "numbers": 2, "all_turn": True,
        }  # fmt: skip
    slide = replace(module, program=program, plan=planned(bounded=None, turning=False))
    assert _elimination(slide)["all_turn"] is False
    assert _elimination(module) == {"routine": ""}
    assert "roots/trig_quartic.hpp" in _headers(module) and "solving/lane_solve.hpp" in _headers(
        module
    )


def test_limits_are_far_by_the_joint_s_own_period() -> None:
    module = with_limits(made_module(), (2.0, 5.0), (-5.0, -2.0), (4.0, 5.0))
    rows = tuple(replace(row, scale=2.0) for row in module.dh.rows)
    half = replace(module, dh=replace(module.dh, rows=rows))
    assert [_far_limits(module, j) for j in range(3)] == [False, False, False]
    assert [_far_limits(half, j) for j in range(3)] == [True, True, False]


@pytest.mark.parametrize(
    ("limits", "far"),
    [
        ((-PI, PI), False), ((-1.0, 4.0), False), ((-4.0, 1.0), False), (EVERY, False),
        ((PI, 4.0), False), ((3.2, 4.0), True), ((-4.0, -PI), False), ((-4.0, -3.2), True),
    ],
)  # fmt: skip
def test_limits_beyond_half_a_turn_on_one_side_are_far(
    limits: tuple[float, float], far: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    told: dict[str, object] = {}
    monkeypatch.setattr(
        "ikgen.emit.cpp.cpp_emitter.render", lambda *_, **values: told.update(values) or ""
    )
    emit_header(with_limits(made_module(), (-1.0, 1.0), limits, (-0.1, 0.2)))
    assert told["far_limits"] is far
    assert told["order"] == [0, 2, 4, 6, 1, 3, 5, 7] and told["held"] == 1 and told["folds"] == 2
    assert told["lower"] == ["-1.0", str(limits[0]) if limits != EVERY else
                             "-std::numeric_limits<double>::infinity()", "-0.1"]  # fmt: skip
    assert (told["guarded"], told["careful"], told["twisted"]) == (False, False, None)
    assert (told["way"], told["rows"], told["closed_form"]) == (
        "LaneSolve",
        "Out",
        "int P, class Out",
    )
    assert told["columns"] == "0, 0, 3" and told["routine"] == ""
    three = replace(made_module().program.levels[2], branches=3)
    program = made_module().program
    emit_header(
        replace(made_module(), program=replace(program, levels=(*program.levels[:2], three)))
    )
    assert (
        told["order"] == [0, 2, 4, 6, 1, 3, 5, 7] and told["most"] == 6
    )  # one of four stays empty


def test_lanes_are_depth_first() -> None:
    assert _depth_first([]) == [0] and _depth_first([2]) == [0, 1]
    assert _depth_first([2, 4]) == [0, 2, 4, 6, 1, 3, 5, 7]
    assert _depth_first([4, 2]) == [0, 4, 1, 5, 2, 6, 3, 7]


def test_which_rows_are_rough_in_cpp() -> None:
    module, policy = made_module(), SolvePolicy()
    assert _rough(module, policy) == f"near | (off > {policy.rough_square})"
    refined = replace(module, dh=replace(module.dh, deviation=(0.0, 1e-3)))
    assert _rough(refined, policy) == "(spread<1>(1.0) > 0.0)"


def test_a_module_is_guarded_where_no_routine_gives_its_branches() -> None:
    module = made_module()
    program = replace(module.program, levels=module.program.levels[:2])
    without = replace(module, program=program)
    assert not module.guarded and without.guarded
    assert not replace(without, plan=planned(bounded=None)).guarded
    assert (module.lanes, module.max_solutions, without.lanes) == (8, 8, 2)
    assert [most_rows(lanes, True) for lanes in (4, 8, 16, 32)] == [8, 16, 16, 32]
    assert [most_rows(lanes, False) for lanes in (4, 32)] == [4, 32]
    assert module.size == 1.0 and module.period(0) == 2 * math.pi and module.period(2) == 0.0


def test_a_planning_group_has_the_solver_s_joints_or_those_of_the_chain() -> None:
    module = made_module()
    assert moveit._group(module, None) == {
        "group": [("q0", 0, 1.0, 0.0), ("q1", 1, 1.0, 0.0), ("q2", 2, 1.0, 0.0)],
        "places": [0, 1, 2], "held_places": [2],
    }  # fmt: skip
    axes = [
        SimpleNamespace(name=name, driver=driver, multiplier=k, offset=c)
        for name, driver, k, c in (
            ("q0", 0, 1.0, 0.0), ("copy", 0, -2.0, 0.5), ("q1", 1, 1.0, 0.0), ("q2", 2, 1.0, 0.0),
        )
    ]  # fmt: skip
    found = moveit._group(module, SimpleNamespace(axes=axes, file_axes=()))
    assert found["places"] == [0, 2, 3] and found["group"][1] == ("copy", 0, -2.0, 0.5)
    held = moveit._group(holding("q1", "q2"), SimpleNamespace(axes=axes, file_axes=()))
    assert held["held_places"] == [2, 3]
    with pytest.raises(UsageError, match="the joint 'q2' moves the chain from outside"):
        moveit._group(module, SimpleNamespace(file_axes=(), axes=axes[:3]))
    rows = module.dh.rows
    with pytest.raises(UsageError, match="rows of a DH table follow others"):
        moveit._group(replace(module, dh=replace(module.dh, rows=(*rows, rows[0]))), None)


@pytest.mark.parametrize(
    ("free", "turning"), [((), [0, 1]), (("q0",), [1]), (("q2",), [0, 1]), (("q0", "q1"), [])]
)
def test_a_plugin_turns_what_is_not_held(free: tuple[str, ...], turning: list[int]) -> None:
    values = moveit._values(holding(*free), "a_package")
    periods = [math.tau if j in turning else 0.0 for j in range(3)]
    assert values["periods"] == [number(period) for period in periods]
    assert values["free_names"] == free
    assert (values["who"], values["email"], values["package"]) == (
        "user",
        "user@todo.todo",
        "a_package",
    )
    assert values["version"] == "0.0.0" and moveit._version("1.2.3.dev4+x") == "1.2.3"
    assert moveit.package_name("Two__Arms") == "two_arms_ik_moveit"


def test_angles_to_fill_in_are_those_without_numbers() -> None:
    module = made_module()
    assert blank_functions(module) == ()
    first, second, third = module.dh.rows
    shared = Angle(0.3, None, "alpha_1", symbolic=True)
    rows = (
        replace(first, alpha=shared),
        replace(
            second, alpha=Angle(0.3, None, "alpha_2"), theta=Angle(0.1, None, None, symbolic=True)
        ),
        replace(third, theta=Angle(0.2, None, "theta_3", symbolic=True), alpha=shared),
    )
    found = blank_functions(replace(module, dh=replace(module.dh, rows=rows)))
    assert found == (*cosine_and_sine("alpha_1"), *cosine_and_sine("theta_3"))


def test_what_was_chosen_to_be_held_is_said_with_what_came_next() -> None:
    plain = Held(("q1",), "fewest sets")
    assert plain.words == "holding q1: fewest sets with it held"
    both = Held(("q1", "q3"), "why", (("q2",), ("q4", "q5")), (("q6",),))
    assert both.words == (
        "holding q1 and q3: why with them held; others: q2, q4 and q5; failed verification: q6"
    )
    behind = replace(both, refused=(), behind=("a narrower range", ""))
    assert behind.words.endswith("; others: q2 (a narrower range), q4 and q5")
    torso = replace(plain, shared=("yaw",))
    carries = (
        "; yaw carries other branches of the robot too: --free NAME holds it in place of another"
    )
    assert torso.words.endswith(carries)
    torso = replace(plain, shared=("yaw", "lift"))
    assert "; yaw and lift carry other branches of the robot too: " in torso.words
