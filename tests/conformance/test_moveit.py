"""The emitted MoveIt package: its files, and the plugin's answers through stub interfaces."""

from __future__ import annotations

import dataclasses
import functools
import shutil
import time
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import moveit_driver as driver
import numpy as np
import pytest
from moveit_driver import Plugin, compile_driver, warnings_of
from numpy.typing import NDArray
from solving import FIXTURES, import_text

from ikgen.emit.module import SolverModule
from ikgen.emit.moveit import emit, package_name
from ikgen.emit.python import emit_module
from ikgen.errors import MissingToolError, UsageError
from ikgen.importers import load_tree
from ikgen.kinematics.forward import file_forward
from ikgen.model.joint_tree import Joint, JointTree, JointType, Limits
from ikgen.pipeline import Request, derive
from ikgen.verify.runners.cpp_toolchain import find_eigen

Array = NDArray[np.float64]

KUKA = "kuka_kr6r900sixx"
FRANKA = "franka_fr3"
STYLES = {KUKA: "hpp", FRANKA: "h"}
SAMPLES = 40


def _missing(*programs: str) -> str:
    absent = [name for name in programs if shutil.which(name) is None]
    try:
        find_eigen()
    except MissingToolError as error:
        return error.message
    return f"needs {', '.join(absent)}" if absent else ""


@functools.cache
def module_of(name: str) -> SolverModule:
    free = (("fr3_joint7", None),) if name == FRANKA else ()
    return derive(Request(FIXTURES / f"{name}.urdf", free=free)).module


def write(module: SolverModule, folder: Path) -> Path:
    for path, text in emit(module).items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text)
    return folder / package_name(module.name)


@dataclass(frozen=True)
class Arm:
    """A solver, its robot, and the driver around its plugin."""

    module: SolverModule
    tree: JointTree
    program: Path

    @property
    def joints(self) -> list[str]:
        return [joint.name for joint in self.module.dh.joints]

    @property
    def base(self) -> str:
        return self.module.dh.base_link

    @property
    def tip(self) -> str:
        return self.module.dh.tip_link

    @property
    def bounds(self) -> tuple[Array, Array]:
        limits = [joint.limits for joint in self.module.dh.joints]
        return np.array([x.lower for x in limits]), np.array([x.upper for x in limits])

    def configurations(self, seed: int, count: int = SAMPLES) -> Array:
        low, high = self.bounds
        return np.random.default_rng(seed).uniform(low, high, (count, len(low)))

    def pose(self, q: Array) -> Array:
        return file_forward(self.module.dh, q)


@functools.cache
def arm_of(name: str, folder: Path) -> Arm:
    package = write(module_of(name), folder / name)
    compile_driver(package, STYLES[name], folder / name / "driver")
    return Arm(module_of(name), load_tree(FIXTURES / f"{name}.urdf"), folder / name / "driver")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("moveit")


@pytest.fixture
def arm(request: pytest.FixtureRequest, folder: Path) -> Arm:
    if missing := _missing("g++"):
        pytest.skip(missing)
    return arm_of(request.param, folder)


@pytest.fixture
def plugin(arm: Arm) -> Iterator[Plugin]:
    """The plugin over the arm's own tree; not yet initialized."""
    running = Plugin(arm.program, len(arm.joints))
    running.load(arm.tree)
    running.group("arm", arm.joints)
    yield running
    running.close()


both = pytest.mark.parametrize("arm", [KUKA, FRANKA], indirect=True)
kuka = pytest.mark.parametrize("arm", [KUKA], indirect=True)
franka = pytest.mark.parametrize("arm", [FRANKA], indirect=True)


def way(rows: Array, seed: Array) -> Array:
    """Sum of what the joints move from the seed."""
    return np.abs(rows - seed).sum(axis=-1)


def fixed(name: str, parent: str, T: Array) -> Joint:
    """A fixed joint to a new link."""
    free = Limits(-np.inf, np.inf)
    return Joint(f"{name}_joint", JointType.FIXED, parent, name, T, np.array([1.0, 0, 0]), free)


def offset(x: float, turn: float) -> Array:
    T = np.eye(4)
    T[:2, :2] = [[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]
    T[:3, 3] = [x, 0.2, -0.1]
    return T


# --- the package --------------------------------------------------------------------------------


@pytest.mark.parametrize("name", [KUKA, FRANKA])
def test_the_files_fit_together(name: str) -> None:
    module = module_of(name)
    package = package_name(module.name)
    files = emit(module)
    assert files == emit(module)
    assert all(path.startswith(f"{package}/") for path in files)
    manifest = ElementTree.fromstring(files[f"{package}/package.xml"])
    assert manifest.get("format") == "3" and manifest.findtext("name") == package
    library = ElementTree.fromstring(files[f"{package}/plugin.xml"])
    exported = library[0].attrib
    assert library.get("path") == package
    assert exported["base_class_type"] == "kinematics::KinematicsBase"
    source = files[f"{package}/src/kinematics_plugin.cpp"]
    assert f"PLUGINLIB_EXPORT_CLASS({exported['type']}, {exported['base_class_type']})" in source
    assert f"kinematics_solver: {exported['name']}\n" in files[f"{package}/config/kinematics.yaml"]
    assert exported["name"] in files[f"{package}/README.md"]
    cmake = files[f"{package}/CMakeLists.txt"]
    assert all(path in files for word in cmake.split() if (path := f"{package}/{word.rstrip(')')}").endswith(".cpp"))  # fmt: skip


def test_odd_names_stay_inside_their_files(tmp_path: Path) -> None:
    odd = 'tool <0> & "--" \n é'
    module = module_of(KUKA)
    dh = dataclasses.replace(module.dh, tip_link=odd, robot=odd)
    files = emit(dataclasses.replace(module, dh=dh, name="My__Arm", generator_version="1.2.3.dev4"))
    manifest = ElementTree.fromstring(files["my_arm_ik_moveit/package.xml"])
    assert f"of {odd}, {dh.base_link} to {odd}, as" in manifest.findtext("description", "")
    assert manifest.findtext("version") == "1.2.3"
    ElementTree.fromstring(files["my_arm_ik_moveit/plugin.xml"])


def test_ros_accepts_the_manifest(tmp_path: Path) -> None:
    catkin = pytest.importorskip("catkin_pkg.package", reason="needs catkin_pkg")
    package = write(module_of(KUKA), tmp_path)
    problems: list[str] = []
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        parsed = catkin.parse_package(str(package), warnings=problems)
    assert not problems and parsed.get_build_type() == "ament_cmake"
    assert {d.name for d in parsed.build_depends} >= {"moveit_core", "pluginlib", "rclcpp"}


def test_chains_with_mimic_joints_are_refused() -> None:
    module = module_of(KUKA)
    dh = dataclasses.replace(module.dh, rows=(*module.dh.rows, module.dh.rows[-1]))
    with pytest.raises(UsageError, match="mimic"):
        emit(dataclasses.replace(module, dh=dh))


@pytest.mark.skipif(bool(_missing("clang++")), reason=_missing("clang++"))
@pytest.mark.parametrize(("name", "style"), [(KUKA, "h"), (FRANKA, "hpp")])
def test_the_other_compiler_has_nothing_to_say(name: str, style: str, tmp_path: Path) -> None:
    assert warnings_of("clang++", write(module_of(name), tmp_path), style) == ""


# --- solutions ------------------------------------------------------------------------------------


@both
def test_one_solution_is_the_nearest_of_all(arm: Arm, plugin: Plugin) -> None:
    assert plugin.initialize(arm.base, arm.tip).good
    low, high = arm.bounds
    found = 0
    for q, seed in zip(arm.configurations(1), arm.configurations(2), strict=True):
        for j in arm.module.free:
            q[j] = seed[j]
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
    assert found > 2 * SAMPLES


@kuka
def test_all_solutions_are_the_python_modules(arm: Arm, plugin: Plugin, tmp_path: Path) -> None:
    python = import_text(emit_module(arm.module), tmp_path)
    assert plugin.initialize(arm.base, arm.tip).good
    for q, seed in zip(arm.configurations(3), arm.configurations(4), strict=True):
        _, rows = plugin.get_all([arm.pose(q)], seed)
        other = python.solve(arm.pose(q), seed=seed).q
        order = np.argsort(way(other, seed), kind="stable")
        assert len(rows) == len(other) and np.abs(rows - other[order]).max() < 1e-9


@kuka
def test_whole_turns_are_those_of_the_seed(arm: Arm, plugin: Plugin) -> None:
    assert plugin.initialize(arm.base, arm.tip).good
    q = np.array([0.3, -1.2, 1.4, 0.5, 0.7, 2.5])
    for seed in (q, q - np.array([0, 0, 0, 0, 0, 2 * np.pi])):
        assert np.abs(plugin.get(arm.pose(q), seed).values - seed).max() < 1e-8


@kuka
def test_limits_of_the_robot_model_narrow_those_of_the_description(arm: Arm, plugin: Plugin) -> None:
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


def with_joint(tree: JointTree, which: str, **changes: object) -> JointTree:
    """The tree with one joint changed."""
    joints = tuple(
        dataclasses.replace(joint, **changes) if joint.name == which else joint  # type: ignore[arg-type]
        for joint in tree.joints
    )
    return dataclasses.replace(tree, joints=joints)


# --- searching ------------------------------------------------------------------------------------


@both
def test_every_search_starts_with_the_nearest(arm: Arm, plugin: Plugin) -> None:
    assert plugin.initialize(arm.base, arm.tip).good
    wide = np.full(len(arm.joints), 20.0)
    for q in arm.configurations(5, 5):
        pose, seed = arm.pose(q), q + 0.01 * (np.arange(len(q)) - 3.0) * (len(arm.module.free) == 0)
        nearest = plugin.get(pose, seed).values
        for words in ([], ["limits"], ["callback"], ["limits", "callback"], ["poses"], ["poses", "callback"]):  # fmt: skip
            limits = wide if "limits" in words or "poses" in words else ()
            found = plugin.search(pose, seed, *words, limits=limits)
            assert found.good and found.code == driver.SUCCESS, words
            assert np.array_equal(found.q, nearest)
            assert len(found.seen) == ("callback" in words)


@both
def test_consistency_limits_are_kept(arm: Arm, plugin: Plugin) -> None:
    assert plugin.initialize(arm.base, arm.tip).good
    n = len(arm.joints)
    for q in 0.9 * arm.configurations(6, 10):
        low, high = arm.bounds
        q = np.clip(q, low + 0.11, high - 0.11)
        seed = q + 0.1 * np.cos(np.arange(n))
        within = plugin.search(arm.pose(q), seed, "limits", limits=np.full(n, 0.12), timeout=0.5)
        if not arm.module.free:
            assert within.good and np.abs(within.q - q).max() < 1e-6
        elif within.good:
            assert np.abs(arm.pose(within.q) - arm.pose(q)).max() < 1e-8
        if within.good:
            assert np.abs(within.q - seed).max() <= 0.12 + 1e-9
        outside = plugin.search(
            arm.pose(q), seed, "limits", "callback", limits=[0.12] * (n - 2) + [1e-4, 0.12], timeout=0.0
        )
        assert not outside.good and len(outside.seen) == 0 and len(outside.q) == 0
        expected = driver.TIMED_OUT if arm.module.free else driver.NO_IK_SOLUTION
        assert outside.code == expected


@both
def test_the_callback_sees_the_candidates_in_order(arm: Arm, plugin: Plugin) -> None:
    assert plugin.initialize(arm.base, arm.tip).good
    seed = arm.configurations(7, 1)[0]
    q = next(
        q for q in np.vstack([seed, arm.configurations(8)]) if _count(plugin, arm.pose(_held(arm, q, seed)), seed) > 2  # fmt: skip
    )
    pose = arm.pose(_held(arm, q, seed))
    _, rows = plugin.get_all([pose], seed)
    for rejections in range(len(rows)):
        found = plugin.search(pose, seed, "callback", "lock", rejections=rejections)
        assert found.good and found.code == driver.SUCCESS
        assert np.array_equal(found.q, rows[rejections])
        assert np.array_equal(found.seen, rows[: rejections + 1])
    none = plugin.search(pose, seed, "callback", "lock", rejections=1000)
    assert not none.good and none.code == driver.GOAL_IN_COLLISION
    assert np.array_equal(none.seen, rows) and len(none.q) == 0
    late = plugin.search(pose, seed, "callback", rejections=1000, wait=0.02, timeout=0.01)
    assert not late.good and late.code == driver.TIMED_OUT and len(late.seen) == 1


def _held(arm: Arm, q: Array, seed: Array) -> Array:
    """The configuration with the seed's values of the held joints."""
    out = q.copy()
    out[list(arm.module.free)] = seed[list(arm.module.free)]
    return out


def _count(plugin: Plugin, pose: Array, seed: Array) -> int:
    return len(plugin.get_all([pose], seed)[1])


@kuka
def test_unreachable_poses_have_no_solution(arm: Arm, plugin: Plugin) -> None:
    assert plugin.initialize(arm.base, arm.tip).good
    pose = arm.pose(np.zeros(6))
    pose[0, 3] = 5.0
    one, (several, rows) = plugin.get(pose, np.zeros(6)), plugin.get_all([pose], np.zeros(6))
    assert not one.good and one.code == driver.NO_IK_SOLUTION
    assert not several.good and several.code == 8 and len(rows) == 0 and several.values == [0.0]
    assert plugin.search(pose, np.zeros(6), "callback").code == driver.NO_IK_SOLUTION


# --- a held joint -----------------------------------------------------------------------------------


@franka
def test_a_held_joint_leaves_the_seed_only_in_a_search(arm: Arm, plugin: Plugin) -> None:
    assert plugin.initialize(arm.base, arm.tip, resolution=0.05).good
    free = arm.module.free[0]
    low, high = arm.bounds
    moved = 0
    for q, seed in zip(arm.configurations(9), arm.configurations(10), strict=True):
        pose = arm.pose(q)
        one = plugin.get(pose, seed)
        assert not one.good or one.values[free] == seed[free]
        if one.good:
            continue
        assert one.code == driver.NO_IK_SOLUTION
        assert plugin.search(pose, seed, "lock", timeout=0.2).code == driver.NO_IK_SOLUTION
        found = plugin.search(pose, seed, timeout=1.0)
        assert found.good and np.abs(arm.pose(found.q) - pose).max() < 1e-8
        assert (low <= found.q).all() and (found.q <= high).all() and found.q[free] != seed[free]
        moved += 1
    assert moved > 3


@franka
def test_values_of_a_held_joint_spread_from_the_seeds(arm: Arm, plugin: Plugin) -> None:
    assert plugin.initialize(arm.base, arm.tip, resolution=0.05).good
    q = np.array([0.1, 0.2, -0.3, -2.0, 0.2, 1.8, 0.4])
    tried = plugin.search(arm.pose(q), q, "callback", rejections=10**6, timeout=0.5)
    assert not tried.good and tried.code == driver.TIMED_OUT
    values = tried.seen[:, arm.module.free[0]]
    low, high = (bound[arm.module.free[0]] for bound in arm.bounds)
    assert (values[: (values == values[0]).sum()] == q[6]).all() and values[0] == q[6]
    assert (low <= values).all() and (values <= high).all()
    gaps = np.diff(np.unique(values))
    assert gaps.max() < 0.05 and np.abs(values[:20] - q[6]).max() < 0.5
    assert np.abs(arm.pose(tried.seen) - arm.pose(q)).max() < 1e-8
    near = plugin.search(arm.pose(q), q, "callback", "limits", rejections=10**6, limits=[0.3] * 7)
    assert len(near.seen) > 10 and np.abs(near.seen - q).max() <= 0.3 + 1e-9


@franka
def test_a_search_ends_when_its_time_is_up(arm: Arm, plugin: Plugin) -> None:
    assert plugin.initialize(arm.base, arm.tip).good
    pose, seed = arm.pose(np.zeros(7)), arm.configurations(11, 1)[0]
    pose[0, 3] = 5.0
    for timeout in (0.0, 0.2):
        start = time.perf_counter()
        found = plugin.search(pose, seed, timeout=timeout)
        assert not found.good and found.code == driver.TIMED_OUT
        assert timeout <= time.perf_counter() - start < timeout + 0.5
    assert plugin.search(arm.pose(seed), seed, timeout=-1.0).good
    assert plugin.search(arm.pose(seed), seed, timeout=float("nan")).good


@franka
def test_discretized_values_of_a_held_joint(arm: Arm, plugin: Plugin) -> None:
    assert plugin.initialize(arm.base, arm.tip, resolution=0.25).good
    q = np.array([0.1, 0.2, -0.3, -2.0, 0.2, 1.8, 0.4])
    free = arm.module.free[0]
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
    at_limit = _held(arm, q, np.clip(beyond, *arm.bounds))
    assert plugin.get(arm.pose(at_limit), beyond).values[free] == arm.bounds[1][free]


# --- frames, groups and bad input -------------------------------------------------------------------


@kuka
def test_frames_may_differ_by_fixed_transforms(arm: Arm, plugin: Plugin) -> None:
    T_cell_base, T_base_table, T_tip_gripper = offset(0.5, 0.7), offset(-0.3, 2.0), offset(0.1, -1.1)
    joints = (
        fixed(arm.tree.root_link, "cell", T_cell_base),
        *arm.tree.joints,
        fixed("table", arm.base, T_base_table),
        fixed("gripper", arm.tip, T_tip_gripper),
        fixed("finger", "gripper", T_tip_gripper),
    )
    plugin.load(dataclasses.replace(arm.tree, joints=joints, root_link="cell"), frame="world")
    plugin.group("arm", arm.joints)
    T_base_root = np.linalg.inv(T_cell_base)
    q = np.array([0.3, -1.2, 1.4, 0.5, 0.7, 2.5])
    for base, T_chain_base in (("cell", T_base_root), ("world", T_base_root), ("/table", T_base_table)):  # fmt: skip
        for tip, T_chain_tip in (("gripper", T_tip_gripper), ("finger", T_tip_gripper @ T_tip_gripper)):  # fmt: skip
            answer = plugin.initialize(base, tip)
            assert answer.good, answer.log
            pose = np.linalg.inv(T_chain_base) @ arm.pose(q) @ T_chain_tip
            good, (reached,) = plugin.forward([tip], q)
            assert good and np.abs(reached - pose).max() < 1e-12
            assert np.abs(plugin.get(pose, q + 0.01).values - q).max() < 1e-8
    _, log = plugin.ask("describe")
    assert log.split("\n")[-2] == "link finger" and log.count("joint") >= 6


@kuka
def test_other_frames_are_refused(arm: Arm, plugin: Plugin) -> None:
    second = next(joint.child for joint in arm.tree.joints if joint.name == arm.joints[1])
    for base, tip, words in (
        (second, arm.tip, "moves between"),
        (arm.base, second, "moves between"),
        ("nowhere", arm.tip, "no link 'nowhere'"),
    ):
        answer = plugin.initialize(base, tip)
        assert not answer.good and words in answer.log
    assert "one tip" in plugin.initialize(arm.base, arm.tip, second).log
    assert "no such group" in plugin.initialize(arm.base, arm.tip, group="legs").log
    plugin.load(arm.tree, frame="world", root_joint="floating")
    plugin.group("arm", arm.joints)
    assert "no link 'world'" in plugin.initialize("world", arm.tip).log
    assert plugin.get(arm.pose(np.zeros(6)), np.zeros(6)).code == driver.NO_IK_SOLUTION
    assert plugin.get_all([arm.pose(np.zeros(6))], np.zeros(6))[0].code == 7
    assert not plugin.forward([arm.tip], np.zeros(6))[0]


@kuka
def test_the_group_has_exactly_the_joints(arm: Arm, plugin: Plugin) -> None:
    for name, joints in (
        ("more", [*arm.joints, "finger"]),
        ("fewer", arm.joints[:-1]),
        ("turned", arm.joints[::-1]),
    ):
        plugin.group(name, joints)
        for answer in (plugin.initialize(arm.base, arm.tip, group=name), plugin.call("supports", name)):  # fmt: skip
            assert not answer.good
            assert f"'{name}' has the joints {', '.join(joints)}" in answer.log
            assert f"needs exactly {', '.join(arm.joints)}" in answer.log
    assert plugin.call("supports", "arm").good


@kuka
def test_another_geometry_is_refused(arm: Arm, plugin: Plugin) -> None:
    joint = next(joint for joint in arm.tree.joints if joint.name == arm.joints[2])
    longer = joint.T_parent_child.copy()
    longer[0, 3] += 1e-3
    plugin.load(with_joint(arm.tree, joint.name, T_parent_child=longer))
    plugin.group("arm", arm.joints)
    answer = plugin.initialize(arm.base, arm.tip)
    assert not answer.good and "1 mm" in answer.log and "generate the solver again" in answer.log
    plugin.load(with_joint(arm.tree, joint.name, name="elbow"))
    plugin.group("arm", arm.joints)
    assert "'elbow' is between base and tip" in plugin.initialize(arm.base, arm.tip).log


@both
def test_bad_input_is_refused(arm: Arm, plugin: Plugin) -> None:
    assert plugin.initialize(arm.base, arm.tip).good
    q = arm.configurations(12, 1)[0]
    pose = arm.pose(q)
    for seed in (q[:-1], [*q, 0.0], np.where(np.arange(len(q)) == 2, np.nan, q)):
        answer = plugin.get(pose, seed)
        assert not answer.good and answer.code == driver.NO_IK_SOLUTION and "seed" in answer.log
        assert not plugin.get_all([pose], seed)[0].good
    wrong = plugin.search(pose, q, "limits", limits=[1.0])
    assert not wrong.good and wrong.code == driver.NO_IK_SOLUTION
    assert not plugin.search(pose, q, "limits", limits=[float("nan")] * len(q), timeout=0.01).good
    assert plugin.get_all([], q)[0].code == 5
    assert plugin.get_all([pose, pose], q)[0].code == 4
    assert plugin.get_all([pose], q, driver.ALL_RANDOM_SAMPLED)[0].code == 2
    if not arm.module.free:
        assert plugin.get_all([pose], q, driver.ALL_DISCRETIZED)[0].code == 2
    for numbers in ([np.nan, 0, 0, 0, 0, 0, 1], [0, 0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0, 2]):
        answer = plugin.call("get", *numbers, len(q), *q)
        assert not answer.good and answer.code == driver.NO_IK_SOLUTION and "pose" in answer.log
    good, poses = plugin.forward([arm.tip, arm.tip], q)
    assert good and len(poses) == 2 and np.abs(poses[0] - pose).max() < 1e-12
    assert not plugin.forward([arm.base], q)[0] and not plugin.forward([arm.tip], q[:-1])[0]
