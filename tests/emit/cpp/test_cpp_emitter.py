"""Which headers of the runtime an arm takes."""

from __future__ import annotations

import re
from dataclasses import replace
from functools import cache
from importlib import import_module
from pathlib import Path

import pytest
from tests.support.cpp_modules import solver_module

import ikgen.runtime
from ikgen.elimination.elimination_table import ELIMINATIONS
from ikgen.emit.cpp.cpp_emitter import _headers, emit_header
from ikgen.emit.solver_module import SolverModule
from ikgen.model.dh import ARM_ANGLE_OPTION
from ikgen.program.routines import ROUTINES, Routine


@cache
def exact() -> SolverModule:
    return solver_module("scara_standard")


@pytest.mark.parametrize("rounded", [False, True])
@pytest.mark.parametrize("task", ["pose", "position"])
@pytest.mark.parametrize("held", [0, 1, 2])
def test_a_header_has_what_its_arm_takes_and_no_more(rounded: bool, task: str, held: int) -> None:
    dh = replace(
        exact().dh,
        free=tuple(joint.name for joint in exact().dh.joints[:held]),
        deviation=(0.0, 1e-3 if rounded else 0.0),
    )
    module = replace(exact(), dh=dh, task=task, free_defaults=(0.0,) * held)
    found = _headers(module)
    assert ("newton/lane_refinement.hpp" in found) == ("held/displacement.hpp" in found) == rounded
    assert ("arm/whole_pose.hpp" in found) == (task == "pose") != ("arm/pose_entries.hpp" in found)
    searches = ("solving/ordered_solving", "held/held_search", "held/held_grid_search")
    assert found[-1] == f"{searches[held]}.hpp"
    assert "solving/path_following.hpp" in found
    assert ("held/lone_value.hpp" in found) == (held > 0)
    assert found[:2] == ["arrays/lane_angle.hpp", "solving/lane_solve.hpp"]
    assert "solving/projection.hpp" in found and "solving/single_solve.hpp" not in found
    assert not {"held/lane_elbow.hpp", "held/arm_angle_motion.hpp"} & set(found)
    if held:
        free = (*dh.free[1:], ARM_ANGLE_OPTION)
        angle = replace(module, dh=replace(dh, free=free))
        assert ("held/lane_elbow.hpp" if rounded else "held/arm_angle_motion.hpp") in _headers(
            angle
        )
        assert ("newton/lane_refinement.hpp" in _headers(angle)) == rounded


@pytest.mark.parametrize("held", [0, 1, 2])
def test_a_header_names_what_is_held_and_where_its_joints_are(held: int) -> None:
    names = tuple(joint.name for joint in exact().dh.joints[1 : 1 + held])
    dh = replace(exact().dh, free=names)
    text = emit_header(replace(exact(), dh=dh, free_defaults=(0.0,) * held))
    head = text[: text.index("namespace detail")]
    quoted = ", ".join(f'"{name}"' for name in names)
    told = f"std::array<const char*, kFree> kFreeNames = {{{quoted}}};"
    places = f"std::array<int, {held}> kFreeJoints = {{{', '.join(map(str, range(1, 1 + held)))}}};"
    assert (told in head) == (places in head) == ("kFreeNames" in head) == bool(held)


@pytest.mark.parametrize("routine", ROUTINES.values(), ids=ROUTINES)
def test_each_routine_is_where_its_row_says(routine: Routine) -> None:
    header = (Path(ikgen.runtime.__file__).parent / "cpp" / routine.cpp_header).read_text()
    if routine.finds_roots:
        module = import_module(f"ikgen.runtime.python.{routine.python_module}")
        assert callable(getattr(module, f"{routine.name}_branches"))
        assert callable(getattr(module, f"{routine.name}_lanes"))
        assert re.search(rf" {routine.name}_branches[({{]", header) and not routine.cpp_class
    else:
        assert f"struct {routine.cpp_class} " in header
        assert routine in {row.called for row in ELIMINATIONS}


def test_there_is_a_row_for_each_header_of_roots() -> None:
    paths = Path(ikgen.runtime.__file__).parent.glob("cpp/roots/trig_*.hpp")
    assert {path.stem for path in paths} == {
        one.name for one in ROUTINES.values() if one.finds_roots
    }
    assert ROUTINES and all(one.takes and one.gives for one in ROUTINES.values())
