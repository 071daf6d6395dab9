"""The viewer: what is drawn is what `solve` gives, in a real browser too where there is one."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.support.browser import browser
from tests.support.viewer import drag_target, on_page, served, viewed

from ikgen.cli.main import run
from ikgen.kinematics.quaternion_rotation import quaternion, rotation
from ikgen.view.branches import solved

ROOT = Path(__file__).resolve().parents[2]
KUKA = "kuka_kr6r900sixx"


def poses(n: int) -> np.ndarray:
    """Poses of random configurations inside the limits, and one out of reach."""
    runner = viewed(KUKA)[1]
    lower, upper = runner.constants.lower, runner.constants.upper
    q = np.random.default_rng(2).uniform(lower, upper, (n, len(lower)))
    far = np.eye(4)
    far[:3, 3] = 9.0
    return np.concatenate([runner.forward(q), far[None]])


def test_a_map_of_another_arm_is_refused() -> None:
    from types import SimpleNamespace

    from ikgen.cli.view_command import _check_map
    from ikgen.errors import UsageError

    dh: Any = SimpleNamespace(robot="one", base_link="base", tip_link="tip")
    found: Any = SimpleNamespace(robot="one", base="base", tip="tip")
    _check_map(found, dh)
    found.tip = "hand"
    with pytest.raises(
        UsageError, match="the map is of one, base to hand, not of one, base to tip"
    ):
        _check_map(found, dh)


def test_quaternions_and_rotations() -> None:
    for q in np.random.default_rng(0).normal(size=(50, 4)):
        R = rotation(q)
        np.testing.assert_allclose(R @ R.T, np.eye(3), atol=1e-12)
        assert np.linalg.det(R) > 0
        np.testing.assert_allclose(rotation(quaternion(R)), R, atol=1e-12)
    quarter = rotation(np.array([np.sqrt(0.5), 0, 0, np.sqrt(0.5)]))
    np.testing.assert_allclose(quarter @ [1, 0, 0], [0, 1, 0], atol=1e-12)


def test_branches_are_those_of_solve() -> None:
    derivation, runner = viewed(KUKA)
    for pose in poses(10):
        answer = solved(derivation, runner, pose)
        inside, status, _ = runner.solve(pose)
        every, _, _ = runner.solve(pose, limits=False)
        assert answer.status == status and len(answer.branches) == len(every)
        assert sum(branch.inside for branch in answer.branches) == len(inside)
        for branch in answer.branches:
            np.testing.assert_allclose(runner.forward(branch.q[None])[0], pose, atol=1e-9)
        assert len({branch.name for branch in answer.branches}) == len(every)
        assert f"{len(inside)} solutions inside the limits" in answer.table(derivation)


def test_viser_is_asked_for_where_it_lacks(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    import sys

    monkeypatch.setitem(sys.modules, "viser", None)
    table = ROOT / "urdf_fixtures/scara_standard.toml"
    assert run(["view", str(table), "-q", "--no-browser"]) == 2
    assert "pip install 'ikgen[view]'" in capsys.readouterr().err


@pytest.fixture
def scene() -> Any:
    """A scene with a server of its own."""
    pytest.importorskip("viser")
    with served(*viewed(KUKA)) as found:
        yield found


def test_moving_the_target_draws_its_solutions(scene: Any) -> None:
    runner = viewed(KUKA)[1]
    assert scene.ghosts > 1
    for pose in poses(5):
        scene.move(pose)
        np.testing.assert_allclose(scene.pose, pose, atol=1e-6)
        assert scene.ghosts == len(runner.solve(scene.pose, limits=False)[0])


def test_the_target_is_dragged_in_a_browser(scene: Any) -> None:
    runner = viewed(KUKA)[1]
    with browser() as opened, on_page(scene, opened) as (page, wrong):
        for axis, way in ((0, 0.5), (1, -0.4)):
            before = scene.pose
            drag_target(page, scene, axis, way)
            moved = before[:3, :3].T @ (scene.pose - before)[:3, 3]
            assert np.argmax(np.abs(moved)) == axis and np.sign(moved[axis]) == np.sign(way)
            assert abs(moved[axis]) > 0.02
            inside = len(runner.solve(scene.pose)[0])
            every = len(runner.solve(scene.pose, limits=False)[0])
            assert scene.ghosts == every
            told = f"{inside} solutions inside the limits of {every}"
            page.get_by_text(told).wait_for(timeout=60_000)
        assert page.locator("canvas").count() >= 1 and wrong == []


def test_a_path_is_clicked_and_followed_in_a_browser(scene: Any) -> None:
    with browser() as opened, on_page(scene, opened) as (page, wrong):
        page.get_by_role("button", name="path").or_(
            page.get_by_text("path", exact=True)
        ).first.click()
        page.get_by_role("button", name="mark the target").click()
        page.get_by_text("poses marked: 1").wait_for(timeout=60_000)
        page.keyboard.down("Shift")
        page.mouse.click(480, 300)
        page.keyboard.up("Shift")
        page.get_by_text("poses marked: 2").wait_for(timeout=60_000)
        page.get_by_role("button", name="follow").click()
        page.get_by_text("poses followed").wait_for(timeout=60_000)
        assert scene.path_panel.followed is not None and wrong == []
