"""Answers of the emitted MoveIt plugin through stub interfaces: solutions."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import tests.support.moveit_driver as driver
from numpy.typing import NDArray
from tests.support.moveit_arms import FRANKA, KUKA, Arm, needs, with_joint
from tests.support.moveit_driver import Plugin
from tests.support.sampled import sampled
from tests.support.solving import import_text

from ikgen.emit.python.python_emitter import emit_module
from ikgen.model.joint_tree import Limits

pytestmark = pytest.mark.usefixtures("solved_once")

Array = NDArray[np.float64]


def way(rows: Array, seed: Array) -> Array:
    """Sum of what the joints move from the seed."""
    return np.abs(rows - seed).sum(axis=-1)


@pytest.mark.parametrize("arm", sampled([KUKA, FRANKA], [KUKA]), indirect=True)
def test_one_solution_is_the_nearest_of_all(arm: Arm, plugin: Plugin) -> None:
    assert plugin.initialize(arm.base, arm.tip).good
    low, high = arm.bounds
    found = 0
    for q, seed in zip(arm.configurations(1), arm.configurations(2), strict=True):
        q = arm.held(q, seed)
        pose = arm.pose(q)
        one = plugin.get(pose, seed)
        answer, rows = plugin.get_all([pose], seed)
        assert one.good and one.code == driver.SUCCESS and answer.good and answer.values == [1.0]
        assert np.array_equal(one.values, rows[0]) and (np.diff(way(rows, seed)) >= 0.0).all()
        assert np.abs(arm.pose(rows) - pose).max() < 1e-8
        assert (low <= rows).all() and (rows <= high).all()
        assert way(rows, q).min() < 1e-5 or np.abs(np.sin(rows - q)).sum(axis=1).min() < 1e-5
        assert np.abs(plugin.get(pose, q).values - q).max() < 1e-5
        found += len(rows)
    assert found > 80


@needs(KUKA)
def test_all_solutions_are_the_python_modules(arm: Arm, plugin: Plugin, tmp_path: Path) -> None:
    python = import_text(emit_module(arm.module), tmp_path)
    assert plugin.initialize(arm.base, arm.tip).good
    for q, seed in zip(arm.configurations(3), arm.configurations(4), strict=True):
        _, rows = plugin.get_all([arm.pose(q)], seed)
        other = python.solve(arm.pose(q), seed=seed).q
        order = np.argsort(way(other, seed), kind="stable")
        assert len(rows) == len(other) and np.abs(rows - other[order]).max() < 1e-9


@needs(KUKA)
def test_whole_turns_are_those_of_the_seed(arm: Arm, plugin: Plugin) -> None:
    assert plugin.initialize(arm.base, arm.tip).good
    q = np.array([0.3, -1.2, 1.4, 0.5, 0.7, 2.5])
    for seed in (q, q - np.array([0, 0, 0, 0, 0, 2 * np.pi])):
        assert np.abs(plugin.get(arm.pose(q), seed).values - seed).max() < 1e-8


@needs(KUKA)
def test_limits_of_the_robot_model_narrow_those_of_the_description(
    arm: Arm, plugin: Plugin
) -> None:
    last = arm.joints[-1]
    q = np.array([0.3, -1.2, 1.4, 0.5, 0.7, 2.5])
    for lower, upper, expected in ((-6.0, 0.0, q[5] - 2 * np.pi), (-1.0, 1.0, None)):
        narrow = with_joint(arm.tree, last, limits=Limits(lower, upper))
        plugin.load(narrow)
        plugin.group("arm", arm.joints)
        assert plugin.initialize(arm.base, arm.tip).good
        answer = plugin.get(arm.pose(q), q)
        _, rows = plugin.get_all([arm.pose(q)], q)
        assert ((lower <= rows[:, 5]) & (rows[:, 5] <= upper)).all()
        if expected is not None:
            assert answer.values[5] == pytest.approx(expected)
    plugin.load(with_joint(arm.tree, last, limits=Limits(10.0, 11.0)))
    plugin.group("arm", arm.joints)
    refused = plugin.initialize(arm.base, arm.tip)
    assert not refused.good and f"no value of the joint '{last}'" in refused.log


@needs(FRANKA)
def test_discretized_values_of_a_held_joint(arm: Arm, plugin: Plugin) -> None:
    assert plugin.initialize(arm.base, arm.tip, resolution=0.25).good
    q = np.array([0.1, 0.2, -0.3, -2.0, 0.2, 1.8, 0.4])
    free = arm.module.free_indices[0]
    answer, rows = plugin.get_all([arm.pose(q)], q, driver.ALL_DISCRETIZED)
    steps = (rows[:, free] - q[free]) / 0.25
    assert answer.good and 0.0 < answer.values[0] <= 1.0
    assert np.abs(steps - np.rint(steps)).max() < 1e-9 and len(np.unique(np.rint(steps))) > 5
    assert (np.diff(way(rows, q)) >= 0.0).all()
    assert np.abs(arm.pose(rows) - arm.pose(q)).max() < 1e-8
    numbers, _ = plugin.ask("describe")
    assert numbers == [free]
    assert plugin.call("redundant", 1, arm.joints[free]).good
    assert not plugin.call("redundant", 1, arm.joints[0]).good
    beyond = q.copy()
    beyond[free] = arm.bounds[1][free] + 0.001
    at_limit = arm.held(q, np.clip(beyond, *arm.bounds))
    assert plugin.get(arm.pose(at_limit), beyond).values[free] == arm.bounds[1][free]
