"""The emitted MoveIt plugin of an arm whose joints follow others: seeds and solutions have all of them."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.coupled_arms import crank_robot
from tests.support.moveit_arms import fixed, missing_tools, offset, with_joint
from tests.support.moveit_driver import Plugin, compile_driver, warnings_of
from tests.support.telescopes import RELATIONS, telescope_robot

from ikgen.derivation.derive import derive
from ikgen.emit.derivation import Derivation
from ikgen.emit.moveit import emit, emit_derivation, package_name
from ikgen.errors import UsageError
from ikgen.importers import load_tree
from ikgen.kinematics.forward import file_forward
from ikgen.model.joint_tree import JointTree, Limits
from ikgen.records.request import Request

Array = NDArray[np.float64]
GROUP = ["lift", "stage_1", "stage_2", "stage_3", "stage_4", "yaw", "pitch"]
MOVING = [0, 1, 5, 6]  # places in the group of those that move the others


@pytest.fixture(scope="module")
def derivation(tmp_path_factory: pytest.TempPathFactory) -> Derivation:
    robot = telescope_robot(tmp_path_factory.mktemp("telescope"))
    return derive(Request(robot, task="position", couple=RELATIONS))


@pytest.fixture(scope="module")
def program(derivation: Derivation, tmp_path_factory: pytest.TempPathFactory) -> Path:
    if missing := missing_tools("g++"):
        pytest.skip(missing)
    folder = tmp_path_factory.mktemp("package")
    for path, text in emit_derivation(derivation).items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text)
    package = folder / package_name(derivation.module.name)
    compile_driver(package, "hpp", folder / "driver")
    return folder / "driver"


@pytest.mark.long  # test_moveit.py compiles another arm's package with these headers
def test_headers_of_earlier_releases_warn_of_nothing(derivation: Derivation, program: Path) -> None:
    package = program.parent / package_name(derivation.module.name)
    assert "warning" not in warnings_of("g++", package, "h")


@pytest.fixture
def plugin(derivation: Derivation, program: Path) -> Iterator[Plugin]:
    running = Plugin(program, len(GROUP))
    running.load(tree_of(derivation))
    running.group("arm", GROUP)
    yield running
    running.close()


def tree_of(derivation: Derivation) -> JointTree:
    return load_tree(derivation.reading.source.path)


def group_values(q: Array) -> Array:
    """Values of the whole group from those that move it."""
    lift, stage, yaw, pitch = q
    return np.array([lift, stage, stage + 0.01, stage + 0.02, 0.5 * stage + 0.03, yaw, pitch])


def configurations(derivation: Derivation, seed: int, count: int = 20) -> Array:
    limits = [joint.limits for joint in derivation.reading.dh.joints]
    low, high = np.array([(x.lower, x.upper) for x in limits]).T
    return np.random.default_rng(seed).uniform(low, high, (count, 4))


def pose_of(derivation: Derivation, q: Array) -> Array:
    return file_forward(derivation.reading.dh, q)


def test_solutions_have_every_joint_of_the_group(derivation: Derivation, plugin: Plugin) -> None:
    assert plugin.initialize("base", "link_7").good
    for q in configurations(derivation, seed=1):
        pose = pose_of(derivation, q)
        answer, rows = plugin.get_all([pose], group_values(q))
        assert answer.good
        for row in rows:
            assert np.allclose(group_values(row[MOVING]), row, atol=1e-12)
            assert np.abs(pose_of(derivation, row[MOVING])[:3, 3] - pose[:3, 3]).max() < 1e-8
        assert np.abs(rows - group_values(q)).max(axis=1).min() < 1e-6
        assert np.abs(plugin.get(pose, group_values(q)).values - group_values(q)).max() < 1e-6
        good, poses = plugin.forward(["link_7"], group_values(q))
        assert good and np.abs(poses[0] - pose).max() < 1e-9


def test_the_tip_stays_where_the_task_leaves_its_orientation_open(
    derivation: Derivation, plugin: Plugin
) -> None:
    tree, T_cell_base = tree_of(derivation), offset(0.5, 0.7)
    ends = (fixed("cell", tree.root_link, T_cell_base), fixed("tool", "link_7", offset(0.1, 0.5)))
    plugin.load(dataclasses.replace(tree, joints=(*tree.joints, *ends)))
    plugin.group("arm", GROUP)
    assert "leaves the tip's orientation open" in plugin.initialize("base", "tool").log
    assert plugin.initialize("cell", "link_7").good
    q = configurations(derivation, seed=3, count=1)[0]
    pose = pose_of(derivation, q)
    answer, rows = plugin.get_all([np.linalg.inv(T_cell_base) @ pose], group_values(q))
    assert answer.good and np.abs(rows[0] - group_values(q)).max() < 1e-8
    assert np.abs(pose_of(derivation, rows[:, MOVING])[:, :3, 3] - pose[:3, 3]).max() < 1e-8


def test_a_followers_limits_and_reach_bound_what_moves_it(
    derivation: Derivation, plugin: Plugin
) -> None:
    q = configurations(derivation, seed=2, count=1)[0]
    q[1] = 0.1
    pose, seed = pose_of(derivation, q), group_values(q)
    plugin.load(with_joint(tree_of(derivation), "stage_4", limits=Limits(0.03, 0.06)))
    plugin.group("arm", GROUP)
    assert plugin.initialize("base", "link_7").good
    assert (plugin.get_all([pose], seed)[1][:, 1] <= 0.06 + 1e-9).all()
    plugin.load(tree_of(derivation))
    plugin.group("arm", GROUP)
    assert plugin.initialize("base", "link_7").good
    start = group_values(q - np.array([0.0, 0.01, 0.0, 0.0]))
    reach = np.full(len(GROUP), np.inf)
    assert plugin.search(pose, start, "limits", "lock", limits=np.full(7, 10.0)).good
    reach[4] = 0.002  # stage_4 has to move 0.0028
    assert not plugin.search(pose, start, "limits", "lock", limits=reach).good


def test_the_group_of_the_solvers_joints_alone_is_refused(
    derivation: Derivation, plugin: Plugin
) -> None:
    plugin.group("short", [GROUP[i] for i in MOVING])
    answer = plugin.initialize("base", "link_7", group="short")
    assert not answer.good and "needs exactly lift, stage_1, stage_2" in answer.log


def test_a_joint_outside_of_the_chain_is_refused(tmp_path: Path) -> None:
    robot = crank_robot(tmp_path, 1.0, (-1.0, 1.0))
    cranked = derive(Request(robot, base="base_link", tip="tool0", task="position"))
    with pytest.raises(UsageError, match="'crank' moves the chain from outside of it") as caught:
        emit_derivation(cranked)
    assert "C++" in caught.value.hint


def test_rows_of_a_table_that_follow_others_are_refused(derivation: Derivation) -> None:
    dh = derivation.module.dh
    table = dataclasses.replace(dh, rows=(*dh.rows, dh.rows[1]))
    with pytest.raises(UsageError, match="MoveIt has no model"):
        emit(dataclasses.replace(derivation.module, dh=table))
