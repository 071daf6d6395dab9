"""Tasks by the tool's axes, and which of them an arm can do everywhere."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ikgen.derivation.read import read
from ikgen.equations.readable import readable_in_dh
from ikgen.errors import UnknownNameError, UsageError
from ikgen.model.dh import DHChain
from ikgen.model.entry_names import ENTRY_NAMES
from ikgen.records.request import Request
from ikgen.tasks import AXES, TASKS, WHOLE_POSE, Task, find_task, smaller_tasks
from ikgen.tasks.fitting import (
    default_tasks,
    fits,
    fitting_tasks,
    freedoms_fixed,
    freedoms_moved,
    keeps_heading_level,
    over_constrained,
)
from ikgen.verify.runners.python_module import _task_name

FIXTURES = Path(__file__).resolve().parents[2] / "urdf_fixtures"

APPROACH = Task("approach", frozenset({"r31"}), 1, "elevation of the tool's {axis} axis", axis="x")
"""As another package has it."""

# Yaw, two parallel joints and a roll about the tool's z axis: its direction does not see the roll.
ROLL = """
name = "roll"
convention = "modified"
[[joints]]
type = "revolute"
alpha = 0
a = 0
d = 0.3
[[joints]]
type = "revolute"
alpha = "-pi/2"
a = 0.1
d = 0
[[joints]]
type = "revolute"
alpha = 0
a = 0.4
d = 0
[[joints]]
type = "revolute"
alpha = 0
a = 0.3
d = 0
[[joints]]
type = "revolute"
alpha = "pi/2"
a = 0
d = 0.2
"""


def chain(name: str) -> DHChain:
    return read(Request(FIXTURES / name)).dh


def roll(folder: Path) -> DHChain:
    path = folder / "roll.toml"
    path.write_text(ROLL)
    return read(Request(path)).dh


def turned(dh: DHChain, R: np.ndarray) -> DHChain:
    X = np.eye(4)
    X[:3, :3] = R
    return replace(dh, X_base=X)


def test_the_axis_chooses_the_column() -> None:
    plain, along = find_task("position-direction"), find_task("position-direction", "x")
    assert plain == find_task("position-direction", "z")
    assert along.name == "position-direction:x" and along.stem == plain.stem
    assert along.readable - plain.readable == {"r11", "r21", "r31"}
    assert "x axis" in along.words and along.orientation == "direction"
    assert find_task(along.name) == along
    assert along.along("z") == plain
    pitch = find_task("TranslationZAxisAngle4D", "y")
    assert pitch.readable == {"px", "py", "pz", "r32"} and pitch.orientation == "pitch"


def test_a_task_says_its_axis_where_it_has_one() -> None:
    with pytest.raises(ValueError, match=r"does not say \{axis\} in its words"):
        replace(APPROACH, says="elevation of the tool's x axis")
    with pytest.raises(ValueError, match="without an axis of the tool"):
        replace(APPROACH, axis="")
    assert APPROACH.along("z").words == "elevation of the tool's z axis"


def test_what_is_offered_in_place_of_a_task_is_smaller() -> None:
    names = [task.name for task in smaller_tasks(5)]
    assert names == ["position-pitch", "position-yaw", "position", "direction"]


def test_tasks_without_a_direction_have_no_axis() -> None:
    for task in TASKS:
        if not task.axis:
            with pytest.raises(UsageError, match="no single axis"):
                find_task(task.name, "x")
    with pytest.raises(UnknownNameError, match="tool axis"):
        find_task("position-pitch:w")


def test_yaw_and_three_parallel_joints_fit_the_elevation() -> None:
    dh = chain("open_manipulator_x.urdf")
    first, second, last = fitting_tasks(dh)
    assert {first.name, second.name} == {"position-pitch", "position-pitch:x"}
    assert first.stem == "position-pitch" and last.whole_pose
    assert over_constrained(dh, last) == 2 and over_constrained(dh, first) == 0
    assert fitting_tasks(dh, "x")[0].name == "position-pitch:x"
    assert not fits(dh, find_task("position-pitch", "y"))  # parallel to the joints: always level
    assert not fits(dh, find_task("position-yaw"))


def test_an_elevation_is_of_an_axis_that_is_not_vertical_in_the_middle() -> None:
    """There both sides of the vertical have one elevation."""
    dh = chain("open_manipulator_x.urdf")
    level = np.eye(4)[[2, 1, 0, 3]] * [[-1.0], [1.0], [1.0], [1.0]]  # the tool's z is level at 0
    other = replace(dh, file_frames=(*dh.file_frames[:-1], dh.file_frames[-1] @ level))
    assert fitting_tasks(dh)[0].name == "position-pitch:x"
    assert fitting_tasks(other)[0].name == "position-pitch"


def test_a_roll_about_the_tool_axis_asks_for_another_axis(tmp_path: Path) -> None:
    dh = roll(tmp_path)
    assert freedoms_moved(dh, find_task("position-direction")) == 4
    assert {task.name for task in fitting_tasks(dh)[:-1]} == {
        "position-direction:x",
        "position-direction:y",
    }
    assert [task.name for task in fitting_tasks(dh, "z")] == ["pose"]


def test_a_tilt_that_changes_counts_with_the_heading() -> None:
    yaw, pitch = find_task("position-yaw"), find_task("position-pitch")
    level, tilting = chain("scara_standard.toml"), chain("open_manipulator_x.urdf")
    assert keeps_heading_level(level, "x") and freedoms_fixed(level, yaw) == 4
    assert not keeps_heading_level(tilting, "x") and freedoms_fixed(tilting, yaw) == 5
    assert over_constrained(tilting, yaw) == 1 and freedoms_fixed(tilting, pitch) == 4


def test_a_heading_is_of_an_axis_that_stays_level() -> None:
    dh = chain("scara_standard.toml")
    turned = np.eye(4)[[2, 1, 0, 3]] * [[-1.0], [1.0], [1.0], [1.0]]  # x of the tool points down
    frames = (*dh.file_frames[:-1], dh.file_frames[-1] @ turned)
    upright = replace(dh, file_frames=frames)
    first = [task.name for task in fitting_tasks(dh)]
    assert first == ["position-yaw", "position-yaw:y", "pose"]
    assert [task.name for task in fitting_tasks(upright)] == [
        "position-yaw:y",
        "position-yaw:z",
        "pose",
    ]
    assert not keeps_heading_level(upright, "x") and keeps_heading_level(upright, "z")
    assert fitting_tasks(upright, "z")[0].name == "position-yaw:z"
    assert find_task("position-yaw", "x") == find_task("position-yaw")
    assert "heading of the tool's z axis" in find_task("position-yaw:z").words


def test_an_axis_that_stays_level_has_no_elevation() -> None:
    """Not even where rounding tilts it by a little."""
    dh = chain("scara_standard.toml")
    tilt = np.eye(4)
    tilt[1:3, 1:3] = [[np.cos(3e-3), -np.sin(3e-3)], [np.sin(3e-3), np.cos(3e-3)]]
    *before, last, tool = dh.file_frames
    tilted = replace(dh, file_frames=(*before, last @ tilt, tool))
    elevation = find_task("position-pitch", "y")
    assert freedoms_moved(tilted, elevation) == 4 and not fits(tilted, elevation)
    names = [task.name for task in fitting_tasks(tilted)]
    assert names == ["position-yaw", "position-yaw:y", "pose"]


PAN_TILT = """<robot name="pan_tilt">
  <link name="base"/><link name="yoke"/><link name="head"/><link name="camera"/><link name="optical"/>
  <joint name="pan" type="continuous"><parent link="base"/><child link="yoke"/><axis xyz="0 0 1"/></joint>
  <joint name="tilt" type="revolute"><parent link="yoke"/><child link="head"/><axis xyz="0 -1 0"/>
    <origin xyz="0 0 0.05"/><limit lower="{low}" upper="{high}"/></joint>
  <joint name="mount" type="fixed"><parent link="head"/><child link="camera"/>
    <origin xyz="0.05 0 0"/></joint>
  <joint name="lens" type="fixed"><parent link="camera"/><child link="optical"/>
    <origin rpy="-1.5707963267948966 0 -1.5707963267948966"/></joint>
</robot>"""


@pytest.mark.parametrize(
    ("tip", "limits", "axis"),
    [
        ("camera", (-0.5, 1.57), "x"),  # which looks ahead; z points along the first axis at 0
        ("optical", (-0.5, 1.57), "z"),  # which looks ahead
        ("camera", (0.4, 1.57), "z"),  # it is vertical nowhere there, and what comes first
        ("camera", (-2.0, 2.0), "z"),  # each is vertical somewhere
    ],
)
def test_a_direction_is_of_an_axis_that_points_along_the_first_joint_nowhere_inside(
    tmp_path: Path, tip: str, limits: tuple[float, float], axis: str
) -> None:
    path = tmp_path / "pan_tilt.urdf"
    path.write_text(PAN_TILT.format(low=limits[0], high=limits[1]))
    task = fitting_tasks(read(Request(path, tip=tip)).dh)[0]
    assert (task.stem, task.axis) == ("direction", axis)


def test_two_links_in_a_plane_are_solved_for_a_position() -> None:
    """No task fits them; of those that do not their position has both elbows."""
    dh = chain("scara_standard.toml")
    planar = replace(dh, free=tuple(joint.name for joint in dh.joints[2:]))
    assert [task.name for task in fitting_tasks(planar)] == ["pose"]
    assert [task.name for task in default_tasks(planar)] == ["position", "pose"]
    assert default_tasks(dh) == fitting_tasks(dh)


def test_six_joints_take_the_whole_pose() -> None:
    assert [task.name for task in fitting_tasks(chain("ur5e.urdf"))] == ["pose"]


def test_entries_are_known_in_dh_frames_where_all_their_parts_are_read(tmp_path: Path) -> None:
    dh = roll(tmp_path)
    pitch = find_task("position-pitch").readable
    assert readable_in_dh(dh, pitch) == pitch
    assert readable_in_dh(dh, WHOLE_POSE) == WHOLE_POSE == frozenset(ENTRY_NAMES)
    axes = np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]])  # the base's z is the chain's y
    assert readable_in_dh(turned(dh, axes), pitch) == {"px", "py", "pz", "r23"}
    c, s = np.cos(0.3), np.sin(0.3)
    tilt = np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
    assert readable_in_dh(turned(dh, tilt), pitch) == {"px", "py", "pz"}


def test_the_bare_name_of_a_task_is_by_its_first_axis(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of tasks of other packages too: what is named alone is found by that name again."""
    plug_in = SimpleNamespace(load=lambda kind: APPROACH)
    monkeypatch.setattr("ikgen.tasks.find_plug_in", lambda *_: plug_in)
    for task in (APPROACH, *(task for task in TASKS if task.axis)):
        for axis in AXES:
            other = find_task(task.name, axis)
            assert find_task(other.name) == other and other.axis == axis
            assert (other.name == task.name) == (axis == task.axis)
            assert other.along(task.axis) == task
    assert find_task("approach", "z").readable == {"r33"}
    module: Any = SimpleNamespace(TASK="approach", TOOL_AXIS="z")
    assert _task_name(module) == "approach:z"
