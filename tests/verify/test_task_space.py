"""What each task compares, the numerical search, and the sampled sets."""

from __future__ import annotations

import numpy as np
import pytest
from tests.support.fake_arms import six_axis_oracle, six_axis_urdf, tree_of
from tests.support.task_spaces import TASK_SPACES

from ikgen.verify.arm import REGULAR_SIGMA, ArmUnderTest, arm_under_test
from ikgen.verify.oracle import PinocchioOracle
from ikgen.verify.reach import invalid_poses, unreachable_poses
from ikgen.verify.sampling import sample_sets
from ikgen.verify.search import find_solutions
from ikgen.verify.singularities import on_continuum
from ikgen.verify.task_space import TaskSpace, _turn


def arm(task: str = "pose", free: tuple[str, ...] = ()) -> ArmUnderTest:
    """The six-axis arm for a task."""
    oracle = six_axis_oracle()
    return arm_under_test(oracle, TASK_SPACES[task], (oracle.lower, oracle.upper), free)


def turned(axis: int, angle: float, shift: float = 0.0) -> np.ndarray:
    """A pose (1, 4, 4) turned about a base axis and shifted along x."""
    i, j = [(1, 2), (2, 0), (0, 1)][axis]
    T = np.eye(4)
    T[i, i] = T[j, j] = np.cos(angle)
    T[i, j], T[j, i] = -np.sin(angle), np.sin(angle)
    T[0, 3] = shift
    return T[None]


@pytest.mark.parametrize(
    ("task", "counts"),  # position, turn about z, turn about x
    [
        ("pose", (True, True, True)),
        ("position", (True, False, False)),
        ("position-direction", (True, False, True)),
        ("position-yaw", (True, True, False)),
        ("position-pitch", (True, False, None)),
        ("rotation", (False, True, True)),
        ("direction", (False, False, True)),
    ],
)
def test_a_task_compares_only_what_it_reads(task: str, counts: tuple[bool | None, ...]) -> None:
    space = TASK_SPACES[task]
    poses = turned(2, 0, 0.25), turned(2, 0.5), turned(0, 0.5)
    for T, counted in zip(poses, counts, strict=True):
        turn = 2.0 * np.sin(0.25) if task == "position-yaw" else 0.5  # of a heading the chord
        error = sum(e[0] for e in space.errors(T, np.eye(4)[None]))
        if counted is None:  # the tool's axis leaves the vertical: the sine of its elevation counts
            assert error == pytest.approx(1.0 - np.cos(0.5))
            continue
        assert error == pytest.approx((turn if T[0, 0, 3] == 0 else 0.25) if counted else 0.0)
    half = space.errors(turned(0, np.pi), np.eye(4)[None])[1][0]
    assert half == pytest.approx({True: np.pi, None: 2.0}.get(counts[2], 0.0))


@pytest.mark.parametrize("task", TASK_SPACES)
def test_task_jacobian_is_the_derivative(task: str) -> None:
    a, space, h = arm(task), TASK_SPACES[task], 1e-6
    q = np.random.default_rng(0).uniform(-1.5, 1.5, (8, 6))
    T, J = a.screws.forward_and_jacobian(q)
    rows = space.jacobian(T, J)
    for k, step in enumerate(h * np.eye(6)):
        moved = space.residual(T, a.screws.forward(q + step)) / h
        assert np.abs(rows[:, :, k] - moved).max() < 1e-4


@pytest.mark.parametrize(
    ("task", "free"),
    [
        ("pose", ()),
        ("position", ("j4", "j5", "j6")),
        ("position-direction", ("j6",)),
        ("rotation", ("j1", "j2", "j3")),
        ("direction", ("j1", "j2", "j3", "j6")),
    ],
)
def test_search_finds_solutions_and_keeps_free_joints(task: str, free: tuple[str, ...]) -> None:
    a, rng = arm(task, free), np.random.default_rng(0)
    q = a.uniform(rng, 5)
    poses = a.oracle.forward(q)
    for pose, held, found in zip(poses, q, find_solutions(a, poses, q, 60, rng), strict=True):
        assert len(found) > 0
        target = np.repeat(pose[None], len(found), axis=0)
        assert max(np.max(e) for e in a.task.errors(a.oracle.forward(found), target)) < 1e-9
        assert np.all(found[:, list(a.free)] == held[list(a.free)])
        assert a.distance(found, held).min() < 1e-6


def test_regular_is_what_is_typical_of_an_arm() -> None:
    """With an elbow 20 m to the side, links of half a metre move little of what the arm's size measures."""
    usual = arm()
    assert usual.regular_above() == REGULAR_SIGMA
    oracle = PinocchioOracle(
        tree_of(six_axis_urdf().replace("0 0 0.5", "0 20 0.5", 1)),
        "l0",
        "tip",
        [f"j{k + 1}" for k in range(6)],
    )
    long = arm_under_test(oracle, TASK_SPACES["pose"], (oracle.lower, oracle.upper), ())
    sigma = sample_sets(long, 200, 0)["random"].sigma
    assert (sigma < REGULAR_SIGMA).all() and 1e-7 < long.regular_above() < REGULAR_SIGMA
    assert (sigma > long.regular_above()).mean() > 0.5


def test_sampled_sets() -> None:
    a = arm()
    sets = sample_sets(a, 200, 0)
    for label, sample in sets.items():
        assert len(sample), label
        assert np.all(a.within(sample.q)) == (label != "outside limits"), label
        assert np.abs(sample.poses - a.oracle.forward(sample.q)).max() == 0
    at_bound = (sets["at limits"].q == a.lower) | (sets["at limits"].q == a.upper)
    assert at_bound.any(axis=1).all()
    assert np.all(sets["special"].q[0] == 0)
    assert (sets["random"].sigma > REGULAR_SIGMA).mean() > 0.9
    assert (sets["singular"].sigma < REGULAR_SIGMA).all()
    again = sample_sets(a, 200, 0)
    assert all(np.array_equal(again[label].q, sets[label].q) for label in sets)


def test_continuum_is_told_from_a_fold() -> None:
    a = arm()
    wrist, elbow = np.array([0.3, 0.4, 1.0, 0.5, 0, 0.7]), np.array([0.3, 0.4, 0, 0.5, 1, 0.7])
    q = np.array([wrist, elbow, [0.3, 0.4, 1.0, 0.5, 1, 0.7]])
    assert a.sigma(q)[:2].max() < 1e-12
    assert on_continuum(a, q, a.oracle.forward(q)).tolist() == [True, False, False]


def test_poses_out_of_reach_are_out_of_reach() -> None:
    a, rng = arm(), np.random.default_rng(0)
    sets = unreachable_poses(a, 8, rng)
    assert set(sets) == {"far outside", "slightly outside"}
    shoulder_to_tip = 0.5 + 0.4 + 0.1
    for poses in sets.values():
        away = np.linalg.norm(poses[:, :3, 3] - [0, 0, 0.4], axis=1)
        assert away.min() > shoulder_to_tip
        assert away.min() < 1.2 * shoulder_to_tip or "far outside" in sets
    assert unreachable_poses(arm("rotation", ("j1", "j2", "j3")), 8, rng) == {}


def test_arm_with_few_joints_leaves_the_manifold() -> None:
    oracle = PinocchioOracle(tree_of(six_axis_urdf()), "l0", "l3", ["j1", "j2", "j3"])
    a = arm_under_test(oracle, TASK_SPACES["pose"], (oracle.lower, oracle.upper), ())
    rng = np.random.default_rng(0)
    poses = unreachable_poses(a, 6, rng)["off the manifold"]
    assert all(len(q) == 0 for q in find_solutions(a, poses, np.zeros((6, 3)), 60, rng))


def test_invalid_poses_depend_on_the_task() -> None:
    assert "reflection" in invalid_poses(TASK_SPACES["pose"], np.eye(4))
    assert "NaN rotation" not in invalid_poses(TASK_SPACES["position"], np.eye(4))
    assert "NaN position" not in invalid_poses(TASK_SPACES["rotation"], np.eye(4))


@pytest.mark.parametrize("angle", [0.0, 1e-12, 1e-3, 1.0, 3.0, np.pi - 1e-6, np.pi])
def test_rotation_vectors_have_the_angle_and_its_axis(angle: float) -> None:
    axis = np.array([0.6, 0.0, 0.8])
    found = _turn(np.sin(angle) * axis[None], np.array([np.cos(angle)]))
    assert np.linalg.norm(found) == pytest.approx(angle, abs=1e-15)
    if 0.0 < angle < np.pi:
        assert found[0] == pytest.approx(angle * axis, abs=1e-9)


def test_half_a_turn_is_about_some_axis_and_none_about_none() -> None:
    cross = np.array([[0.0, 0.0, 0.0], [0.0, 1e-10, 0.0], [0.0, 0.0, 0.0], [0.0, 1e-10, 0.0]])
    found = _turn(cross, np.array([-1.0, -1.0, 1.0, 1.0]))
    assert np.linalg.norm(found, axis=1)[:2] == pytest.approx([np.pi, np.pi])
    np.testing.assert_array_equal(found[2], np.zeros(3))
    np.testing.assert_allclose(found[3], cross[3], rtol=1e-12)


@pytest.mark.parametrize(("a", "b"), [(3.0, -3.0), (-3.0, 3.0), (0.5, -0.25), (-3.1, -3.0)])
def test_headings_differ_by_the_chord_between_them(a: float, b: float) -> None:
    T, target = turned(2, a), turned(2, b)
    space = TASK_SPACES["position-yaw"]
    np.testing.assert_allclose(space.residual(T, target)[0, 3:], target[0, :2, 0] - T[0, :2, 0])
    assert space.errors(T, target)[1][0] == pytest.approx(2.0 * abs(np.sin((b - a) / 2.0)))


def test_a_tilt_shortens_a_heading() -> None:
    error = TASK_SPACES["position-yaw"].errors(turned(1, 0.5), np.eye(4)[None])[1][0]
    assert error == pytest.approx(1.0 - np.cos(0.5))


def test_entries_count_each_for_itself_those_of_the_position_as_lengths() -> None:
    space = TaskSpace("made", 3, False, "", ((0, 3), (1, 0), (2, 3)))
    assert space.lengths == [0, 2]
    T, target = np.eye(4)[None], np.eye(4)[None].copy()
    target[0, :3, 3], target[0, 1, 0] = (0.3, 9.0, -0.4), 0.25
    np.testing.assert_allclose(space.residual(T, target), [[0.3, 0.25, -0.4]])
    position, rotation = space.errors(T, target)
    assert (position[0], rotation[0]) == (pytest.approx(0.5), pytest.approx(0.25))
    J = np.arange(12.0).reshape(1, 6, 2)
    np.testing.assert_allclose(space.jacobian(T, J), [[J[0, 0], J[0, 5], J[0, 2]]])
    both = TaskSpace("made", 3, True, "")
    assert both.lengths == [0, 1, 2] and both.errors(T, target)[1].tolist() == [0.0]
