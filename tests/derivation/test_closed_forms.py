"""How much is tried for chains with many joints to hold."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from tests.support.redundant_arms import Joint, serial_urdf
from tests.support.solving import FIXTURES
from tests.support.tables import table

from ikgen.derivation.announcements import announcements
from ikgen.derivation.closed_forms import rule_tries
from ikgen.derivation.derive import derive
from ikgen.derivation.inspection import inspect_robot
from ikgen.errors import IkgenError
from ikgen.records.request import Request

pytestmark = pytest.mark.usefixtures("solved_once")


@pytest.mark.parametrize(("beside", "quartic"), [(3e-5, False), (3e-4, True)])
def test_a_quartic_of_lengths_that_it_divides_by_is_none_of_rounding(
    beside: float, quartic: bool, tmp_path: Path
) -> None:
    """Off by round-off over the length's square rows are lost."""
    turn = (-2.9, 2.9)
    made: list[Joint] = [
        ("yaw", "revolute", "0 0 1", "0 0 0.2", turn),
        ("shoulder", "revolute", "0 1 0", f"0 {beside} 0.1", turn),
        ("elbow", "revolute", "0 1 0", "0 0 0.35", turn),
        ("wrist", "revolute", "0 1 0", "0 0 0.3", turn),
        ("roll", "revolute", "0 0 1", "0 0 0.1", turn),
    ]
    path, on_axis = tmp_path / "beside.urdf", '"tool0"/><origin xyz="0 0'
    text = serial_urdf("beside", made)
    assert on_axis in text
    path.write_text(text.replace(on_axis, f'"tool0"/><origin xyz="0 {beside}'))
    found = derive(Request(path)).module
    assert found.reads.stem == "position-direction"
    assert any("quartic" in step for step in found.order) == quartic
    assert found.rounded is not quartic


def test_a_quartic_of_a_geometry_far_off_gives_way_to_the_elimination(tmp_path: Path) -> None:
    """As measured arms are: each axis by a millimetre and a milliradian, more than two roots are apart."""
    noise = np.random.default_rng(3)

    def moved(match: re.Match[str]) -> str:
        rpy, xyz = (
            [float(x) + noise.uniform(-1e-3, 1e-3) for x in match[k].split()] for k in (1, 2)
        )
        return f'<origin xyz="{xyz[0]} {xyz[1]} {xyz[2]}" rpy="{rpy[0]} {rpy[1]} {rpy[2]}"'

    text = (FIXTURES / "ur5e.urdf").read_text()
    text, count = re.subn(r'<origin rpy="([^"]*)" xyz="([^"]*)"', moved, text)
    assert count > 5
    path = tmp_path / "measured.urdf"
    path.write_text(text)
    derived = derive(Request(path, tip="tool0"))
    assert derived.module.order == ("all joints (6R elimination)",)
    assert not derived.module.rounded


@pytest.mark.parametrize(("offset", "rules"), [(2e-5, True), (4e-4, False)])
def test_offsets_that_add_up_give_way_to_the_elimination(
    offset: float, rules: bool, tmp_path: Path
) -> None:
    """Each is short enough to count as zero in a wrist that is meant to be spherical."""
    turn = (-2.9, 2.9)
    made: list[Joint] = [
        ("yaw", "revolute", "0 0 1", "0 0 0.2", turn),
        ("shoulder", "revolute", "0 1 0", "0.05 0 0.1", turn),
        ("elbow", "revolute", "0 1 0", "0 0 0.3", turn),
        ("roll", "revolute", "0 0 1", f"{offset} {offset} 0.05", turn),
        ("pitch", "revolute", "0 1 0", f"{-offset} {-offset} 0.2", turn),
        ("turn", "revolute", "0 0 1", f"{-offset} {offset} 0.01", turn),
    ]
    path = tmp_path / "wrist.urdf"
    path.write_text(serial_urdf("wrist", made))
    module = derive(Request(path)).module
    assert (module.order == ("all joints (6R elimination)",)) is not rules
    assert module.rounded is rules


def parallel(joints: int, folder: Path) -> Request:
    """A chain of parallel joints, each link longer than the one before."""
    made: list[Joint] = [
        (f"q{i}", "revolute", "0 0 1", f"{0.1 + 0.013 * i:.3f} 0 0", (-3.0, 3.0))
        for i in range(joints)
    ]
    path = folder / "parallel.urdf"
    path.write_text(serial_urdf("parallel", made))
    return Request(path)


@pytest.mark.parametrize(("joints", "tries"), [(6, 8), (8, 8), (9, 5), (12, 2), (16, 1)])
def test_longer_chains_get_fewer_tries(joints: int, tries: int) -> None:
    assert rule_tries(table(*[("R", "1", 0.1, 0.2)] * joints)) == tries


def test_many_parallel_joints_have_a_closed_form(tmp_path: Path) -> None:
    found = inspect_robot(parallel(12, tmp_path))
    best = found.closed[0]
    assert best.max_solutions == 2 and len(best.free) == 9


@pytest.mark.parametrize("joints", [20, 100])
def test_more_joints_than_can_be_solved_are_refused_with_a_way_out(
    joints: int, tmp_path: Path
) -> None:
    with pytest.raises(IkgenError, match=f"{joints} joints move") as caught:
        inspect_robot(parallel(joints, tmp_path))
    assert "--lock" in caught.value.hint


SKEW: tuple[Joint, ...] = (
    ("swing", "revolute", "0.3 0 1", "0 0 0.2", (-2.9, 2.9)),
    ("lift", "revolute", "0 1 0.2", "0.1 0 0.1", (-2.0, 2.0)),
    ("twist", "revolute", "1 0.4 0", "0 0.05 0.3", (-2.9, 2.9)),
    ("bend", "revolute", "0.1 1 0", "0.2 0 0.1", (-2.0, 2.0)),
)
"""Four joints whose axes are in no special way to each other."""


def test_an_arm_that_fits_no_task_gets_the_position_with_a_joint_held(tmp_path: Path) -> None:
    path = tmp_path / "skew.urdf"
    path.write_text(serial_urdf("skew", list(SKEW)))
    found = derive(Request(path))
    assert found.task.name == "position" and len(found.module.free_indices) == 1 and found.chosen
    assert found.held is not None and not any("OVER" in text for text in announcements(found))
    whole = derive(Request(path, task="pose"))
    assert whole.module.free_indices == () and any("OVER" in text for text in announcements(whole))
    held = derive(Request(path, free={"twist": None}))
    assert held.module.held == ("twist",) and held.task.name == "position"
    first = inspect_robot(Request(path)).attempts[0]
    assert first.default and first.task == "position" and first.free == found.reading.dh.free
