"""The panels beside the scene: paths that are followed, sweeps of held joints, maps, meshes."""

from __future__ import annotations

import threading
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
import pytest
from tests.support.browser import browser
from tests.support.redundant_arms import SHOULDER_ELBOW_WRIST, serial_urdf
from tests.support.telescopes import RELATIONS, telescope_robot
from tests.support.viewer import on_page, served, viewed

from ikgen.derivation.derive import derive
from ikgen.derivation.read import read
from ikgen.errors import MissingToolError
from ikgen.kinematics.forward import file_forward
from ikgen.reach.grid import grid_over
from ikgen.reach.reach_map import interpreted_engine, reach_map
from ikgen.records.request import Request
from ikgen.report.worked_example import solver_of
from ikgen.view.followed_path import between, followed
from ikgen.view.robot_meshes import robot_meshes

pytestmark = pytest.mark.usefixtures("solved_once")

ROOT = Path(__file__).resolve().parents[2]
pytest.importorskip("viser")


KUKA, FRANKA = "kuka_kr6r900sixx", "franka_fr3"


def moved(pose: np.ndarray, *way: float) -> np.ndarray:
    """A pose further by so much (m) in the base link."""
    out = pose.copy()
    out[:3, 3] += way
    return out


def test_poses_between_marks_are_near_each_other_and_lead_through_the_marks() -> None:
    runner = viewed(KUKA)[1]
    q = np.random.default_rng(4).uniform(-1, 1, (4, 6))
    marks = list(runner.forward(q))
    poses = between(marks, 1.0)
    for mark in marks:
        assert np.abs(poses - mark).max(axis=(1, 2)).min() < 1e-9
    assert np.linalg.norm(np.diff(poses[:, :3, 3], axis=0), axis=1).max() < 0.021
    turns = np.einsum("nji,njk->nik", poses[:-1, :3, :3], poses[1:, :3, :3])
    assert np.arccos(np.clip((np.trace(turns, axis1=1, axis2=2) - 1) / 2, -1, 1)).max() < 0.021
    np.testing.assert_allclose(
        poses[:, :3, :3] @ poses[:, :3, :3].transpose(0, 2, 1), np.tile(np.eye(3), (len(poses), 1, 1)),
        atol=1e-12,
    )  # fmt: skip


def test_a_path_out_of_reach_says_where_the_status_changes() -> None:
    runner = viewed(KUKA)[1]
    q = np.array([0.2, -0.9, 1.1, 0.3, 0.6, -0.4])
    start = runner.forward(q[None])[0]
    poses = between([start, moved(start, 0.05, 0, 0.02), moved(start, 2.0, 0, 0.02)], 1.0)
    found = followed(runner, poses, q, None)
    assert 2 < len(found.q) < len(poses) and found.status != "OK"
    np.testing.assert_allclose(runner.forward(found.q), poses[: len(found.q)], atol=1e-9)
    assert np.abs(np.diff(found.q, axis=0)).max() < 0.3
    assert found.changes and found.alone[0] == "OK" and found.alone[-1] == "UNREACHABLE"
    assert found.status in found.words and f"**{len(found.q)} of {len(poses)}**" in found.words


def test_marked_poses_are_followed_and_looked_at() -> None:
    derivation, runner = viewed(KUKA)
    with served(derivation, runner) as scene:
        panel = scene.path_panel
        panel.follow()
        assert panel.followed is None
        start = scene.pose
        panel.mark(start)
        panel.mark(moved(start, -0.05, 0.02, 0.0))
        panel.follow()
        assert panel.followed is not None and panel.followed.status == "OK"
        np.testing.assert_allclose(panel.followed.q[0], scene.chosen, atol=1e-6)
        scene.show(panel.followed.q[-1])
        assert scene.ghosts == 0
        np.testing.assert_allclose(
            runner.forward(scene.chosen[None])[0], panel.marks[-1], atol=1e-9
        )
        panel.clear()
        assert panel.followed is None and scene.ghosts > 1
        scene.choose(2)
        np.testing.assert_allclose(scene.chosen, scene.answer.branches[1].q)


def test_a_sweep_goes_over_the_range_of_the_held_joint_and_can_be_ended() -> None:
    derivation, runner = viewed(FRANKA)
    with served(derivation, runner) as scene:
        panel = scene.held_panel
        (slider,) = panel._sliders
        assert panel.values is not None
        j = derivation.module.free_indices[0]
        limits = derivation.reading.dh.joints[j].limits
        start, seen = slider.value, []
        slider.on_update(lambda _: seen.append(slider.value))
        drawn = panel.sweep(slider, seconds=0.0)
        assert drawn > 100 and abs(slider.value - start) < 1e-6
        assert min(seen) < limits.lower + 0.2 and max(seen) > limits.upper - 0.2
        motion = runner.module.self_motion(scene.pose)
        assert f"{min(one.low for one in motion):.2f} to" in panel.words
        threading.Timer(0.2, panel.stop).start()
        assert panel.sweep(slider, seconds=60.0) < 100


def test_the_arm_angle_has_a_slider(tmp_path: Path) -> None:
    path = tmp_path / "arm.urdf"
    path.write_text(serial_urdf("arm", SHOULDER_ELBOW_WRIST))
    derivation = derive(Request(path, free={"arm-angle": None}))
    runner = solver_of(derivation)
    assert runner is not None
    with served(derivation, runner) as scene:
        (slider,) = scene.held_panel._sliders
        start = runner.module.arm_angle(scene.chosen)
        assert slider.label == "arm-angle" and abs(slider.value - start) < 1e-9
        assert (slider.min, slider.max) == (-np.pi, np.pi)
        with browser() as opened, on_page(scene, opened) as (page, wrong):
            with_box = "xpath=ancestor::div[.//input[@inputmode='decimal']][1]"
            line = page.get_by_text(slider.label, exact=True).locator(with_box)
            box = line.locator("input[inputmode=decimal]")
            box.fill("0.7")
            box.press("Enter")
            page.wait_for_timeout(1000)
            assert abs(slider.value - 0.7) < 1e-9 and wrong == []
        rows = np.array([branch.q for branch in scene.answer.branches])
        assert len(rows) == scene.ghosts > 1
        np.testing.assert_allclose(runner.module.arm_angle(rows), 0.7, atol=1e-8)
        assert "solutions for arm-angle at" in scene.held_panel.words


def test_the_map_is_drawn_as_points() -> None:
    derivation, runner = viewed(KUKA)
    grid = grid_over(derivation.reading.dh, 6, 4, 1)
    engine = interpreted_engine(derivation)
    found = reach_map(derivation, grid, engine, engine.size, None)
    with served(derivation, runner, reach=found) as scene:
        panel = scene.reach_panel
        reached = found.by_position.ravel() > 0
        assert panel.points == reached.sum() > 10
        panel.show(from_y=0.0)
        assert panel.points == (reached & (grid.positions[:, 1] >= 0)).sum()
        panel._shown.value = False
        panel.draw()
        assert panel.points == 0
    with served(derivation, runner) as scene:
        assert scene.reach_panel.points == 0
        scene.reach_panel.show(from_y=-9.0)
        assert scene.reach_panel.points > 500


def with_visuals(folder: Path, base: str = "base_link") -> Path:
    """The KUKA with a mesh, a box and one mesh that no description may read."""
    import trimesh

    (folder / "meshes").mkdir()
    trimesh.creation.icosphere(radius=0.05).export(folder / "meshes/tip.stl")
    trimesh.creation.icosphere(radius=0.05).export(folder.parent / f"{folder.name}.stl")
    robot = ElementTree.parse(ROOT / f"urdf_fixtures/{KUKA}.urdf")
    shapes = {
        "link_6": '<mesh filename="meshes/tip.stl"/>',
        base: '<box size="0.3 0.3 0.1"/>',
        "link_1": f'<mesh filename="../{folder.name}.stl"/>',
        "link_2": '<mesh filename="package://nowhere/at/all.dae"/>',
    }
    for link, shape in shapes.items():
        (element,) = robot.findall(f"link[@name='{link}']")
        element.append(ElementTree.fromstring(f"<visual><geometry>{shape}</geometry></visual>"))
    path = folder / "robot.urdf"
    robot.write(path)
    return path


def test_meshes_follow_the_chain_and_are_read_inside_the_package_alone(tmp_path: Path) -> None:
    folder = tmp_path / "package"
    folder.mkdir()
    derivation = derive(Request(with_visuals(folder)))
    runner = solver_of(derivation)
    assert runner is not None
    with served(derivation, runner) as scene:
        assert scene.meshes is not None
        urdf = scene.meshes._urdf
        assert len(urdf.scene.geometry) == 2
        q = np.array([0.2, -0.9, 1.1, 0.3, 0.6, -0.4])
        scene.show(q)
        T = urdf.get_transform("tool0", "base_link")
        np.testing.assert_allclose(T, file_forward(derivation.reading.dh, q), atol=1e-6)
        scene._show_meshes(False)
        assert not scene.meshes.visible


FLAPS = """<robot>
<link name="flap"/><link name="flap_of_flap"/><link name="slider"/>
<joint name="first" type="revolute"><parent link="link_3"/><child link="flap"/><axis xyz="0 0 1"/>
  <limit lower="-9" upper="9" effort="1" velocity="1"/>
  <mimic joint="joint_a2" multiplier="0.5" offset="0.1"/></joint>
<joint name="second" type="continuous"><parent link="flap"/><child link="flap_of_flap"/><axis xyz="0 0 1"/>
  <mimic joint="first" multiplier="-3" offset="0.2"/></joint>
<joint name="third" type="prismatic"><parent link="flap_of_flap"/><child link="slider"/><axis xyz="1 0 0"/>
  <limit lower="-9" upper="9" effort="1" velocity="1"/><mimic joint="second" multiplier="0.1"/></joint>
</robot>"""


def test_what_follows_a_follower_is_drawn_where_it_is(tmp_path: Path) -> None:
    path = with_visuals(tmp_path)
    robot = ElementTree.parse(path)
    robot.getroot().extend(ElementTree.fromstring(FLAPS))
    robot.write(path)
    derivation = derive(Request(path, tip="tool0"))
    runner = solver_of(derivation)
    assert runner is not None
    with served(derivation, runner) as scene:
        assert scene.meshes is not None
        urdf = scene.meshes._urdf
        for lift in (-0.9, 0.4):
            scene.show(np.array([0.2, lift, 1.1, 0.3, 0.6, -0.4]))
            first = 0.5 * lift + 0.1
            second = -3 * first + 0.2
            turn = np.arctan2(*urdf.get_transform("flap_of_flap", "link_3")[1::-1, 0])
            assert abs(np.sin(turn - first - second)) < 1e-9 < np.cos(turn - first - second)
            T = urdf.get_transform("slider", "flap_of_flap")
            np.testing.assert_allclose(T[:3, 3], [0.1 * second, 0, 0], atol=1e-9)


def test_stages_that_follow_by_request_move_their_meshes(tmp_path: Path) -> None:
    path = telescope_robot(tmp_path)
    shape = '<visual><geometry><box size="0.1 0.1 0.1"/></geometry></visual>'
    path.write_text(
        path.read_text().replace('<link name="link_4"/>', f'<link name="link_4">{shape}</link>')
    )
    derivation = derive(Request(path, couple=RELATIONS))
    runner = solver_of(derivation)
    assert runner is not None
    with served(derivation, runner) as scene:
        assert scene.meshes is not None
        dh = derivation.reading.dh
        q = np.array([j.limits.lower + 0.3 * (j.limits.upper - j.limits.lower) for j in dh.joints])
        scene.show(q)
        T = scene.meshes._urdf.get_transform(dh.tip_link, dh.base_link)
        np.testing.assert_allclose(T, file_forward(dh, q), atol=1e-6)


def test_a_robot_without_meshes_has_none() -> None:
    class NoScene:
        """Nothing may be drawn."""

    assert robot_meshes(NoScene(), viewed(KUKA)[0].reading) is None
    assert (
        robot_meshes(NoScene(), read(Request(ROOT / "urdf_fixtures/scara_standard.toml"))) is None
    )


def test_meshes_of_a_robot_by_name_are_found() -> None:
    try:
        derivation = derive(Request(Path("example-robot-data:ur5")))
    except MissingToolError:
        pytest.skip("needs example-robot-data")
    runner = solver_of(derivation)
    assert runner is not None
    with served(derivation, runner) as scene:
        assert scene.meshes is not None and len(scene.meshes._urdf.scene.geometry) >= 6
