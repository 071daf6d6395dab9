"""Of a pose that an arm cannot take, the nearest one that it can: by search, and in both languages."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.routines import compiled_header, feed
from tests.support.sampled import sampled

from ikgen.derivation.derive import derive
from ikgen.emit.cpp.cpp_emitter import emit_header
from ikgen.emit.python.python_emitter import emit_module
from ikgen.records.request import Request

pytestmark = pytest.mark.usefixtures("solved_once")

Array = NDArray[np.float64]

FIXTURE = Path(__file__).resolve().parents[2] / "urdf_fixtures/open_manipulator_x.urdf"
DRIVER = r"""
#include <cstdio>
#include "HEADER"
int main() {
  Eigen::Isometry3d pose;
  ik::Options options;
  options.project = true;
  for (;;) {
    for (int i = 0; i < 16; ++i)
      if (std::scanf("%lf", &pose.matrix().data()[i]) != 1) return 0;
    const ik::Solutions found = ik::solve(pose, options);
    std::printf("%d", static_cast<int>(found.status));
    for (std::size_t k = 0; k < found.size(); ++k) {
      for (int j = 0; j < ik::kDof; ++j) std::printf(" %.17g", found.q[k][j]);
      std::printf(" %.17g %.17g", found.off[k][0], found.off[k][1]);
    }
    std::printf("\n");
  }
}
"""


def emitted(task: str, folder: Path) -> tuple[ModuleType, str]:
    """The Python module and the header's text of the fixture for a task."""
    module = derive(Request(FIXTURE, task=task, name=f"projected_{task.replace('-', '_')}")).module
    path = folder / f"{module.name}_ik.py"
    path.write_text(emit_module(module))
    spec = importlib.util.spec_from_file_location(path.stem, path)
    assert spec is not None and spec.loader is not None
    loaded = importlib.util.module_from_spec(spec)
    sys.modules[path.stem] = loaded
    spec.loader.exec_module(loaded)
    return loaded, emit_header(module)


@pytest.fixture(scope="module", params=["pose", "position-pitch"])
def arm(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    return emitted(str(request.param), tmp_path_factory.mktemp("projection"))[0]


def displaced(arm: ModuleType, count: int) -> tuple[Array, Array]:
    """Configurations, and poses beside theirs: 1e-4, 0.01, 0.3 and 2 rad, and tenths of it in m."""
    rng = np.random.default_rng(3)
    q = rng.uniform(arm.LOWER, arm.UPPER, (count, arm.DOF))
    poses = arm.forward(q)
    for T, angle in zip(poses, np.tile([1e-4, 1e-2, 0.3, 2.0], count), strict=False):
        axis = rng.standard_normal(3)
        x, y, z = axis / np.linalg.norm(axis)
        K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        T[:3, :3] = T[:3, :3] @ (np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K)
        T[:3, 3] += 0.1 * angle * rng.standard_normal(3)
    return q, poses


def off(arm: ModuleType, q: Array, T: Array) -> Array:
    """m and rad by which configurations' poses are off one, by the rotation's angle or the elevation."""
    P = arm.forward(q)
    metres = np.linalg.norm(P[..., :3, 3] - T[:3, 3], axis=-1)
    if arm.TASK == "position-pitch":
        axis = "xyz".index(arm.TOOL_AXIS)
        return np.stack([metres, np.abs(np.arcsin(P[..., 2, axis]) - np.arcsin(T[2, axis]))], -1)
    chord = np.linalg.norm(P[..., :3, :3] - T[:3, :3], axis=(-2, -1))
    return np.stack([metres, 2.0 * np.arcsin(np.minimum(chord / np.sqrt(8.0), 1.0))], -1)


def cost(arm: ModuleType, q: Array, T: Array) -> Array:
    metres, radians = np.moveaxis(off(arm, q, T), -1, 0)
    if arm.TASK == "position-pitch":
        axis = "xyz".index(arm.TOOL_AXIS)
        return np.asarray(metres**2 + (arm.forward(q)[..., 2, axis] - T[2, axis]) ** 2)
    return np.asarray(metres**2 + (2.0 * np.sin(radians / 2)) ** 2)


def test_no_configuration_is_nearer(arm: ModuleType) -> None:
    rng = np.random.default_rng(0)
    generating, poses = displaced(arm, 12)
    everywhere = rng.uniform(arm.LOWER, arm.UPPER, (20000, arm.DOF))
    for at, T in zip(generating, poses, strict=True):
        found = arm.solve(T, project=True)
        assert found.status == "OK" and len(found) >= 1
        assert (found.q >= arm.LOWER).all() and (found.q <= arm.UPPER).all()
        assert np.abs(found.off - off(arm, found.q, T)).max() < 1e-7
        mine = cost(arm, found.q, T)
        beside = found.q[0] + 1e-3 * rng.standard_normal((2000, arm.DOF))
        others = np.vstack([everywhere, at, np.clip(beside, arm.LOWER, arm.UPPER)])
        assert mine.max() <= cost(arm, others, T).min() * (1 + 1e-6) + 1e-13


def test_no_other_start_leads_nearer(arm: ModuleType) -> None:
    """To poses far from all that the arm can take: steps from fifty times as many starts."""
    rng = np.random.default_rng(5)
    solver = arm._ARM
    low, high = np.array(arm.LOWER), np.array(arm.UPPER)
    bounds = arm._step_bounds(solver, True)
    for T in displaced(arm, 24)[1][3::4]:
        T[:3, 3] *= rng.uniform(0.7, 1.5)
        found = arm.solve(T, project=True)
        starts = rng.uniform(np.maximum(low, -np.pi), np.minimum(high, np.pi), (1000, arm.DOF))
        aims = np.broadcast_to(T, (len(starts), 4, 4))
        ends, _ = arm._descend_to(solver, aims, starts, bounds, 1e-16)
        assert cost(arm, found.q, T).max() <= cost(arm, ends, T).min() * (1 + 1e-6) + 1e-13


def test_a_pose_that_the_arm_can_take_is_answered_as_without(arm: ModuleType) -> None:
    for q in np.random.default_rng(1).uniform(arm.LOWER, arm.UPPER, (20, arm.DOF)):
        T = arm.forward(q)
        plain, found = arm.solve(T), arm.solve(T, project=True)
        assert np.array_equal(plain.q, found.q)
        assert not plain.off.any() and plain.off.shape == (len(plain), 2)
        assert found.off.max() < 1e-7


def test_what_is_no_pose_stays_invalid(arm: ModuleType) -> None:
    assert arm.solve(np.full((4, 4), np.nan), project=True).status == "INVALID"


def by_header(task: str, header: str, poses: Array, folder: Path) -> list[list[float]]:
    """Of each pose the status, then rows with what they are off."""
    (folder / "arm_ik.hpp").write_text(header)
    text = DRIVER.replace("HEADER", str(folder / "arm_ik.hpp"))
    text = text.replace(
        "int main", f"namespace ik = projected_{task.replace('-', '_')}_ik;\nint main"
    )
    lines = feed(compiled_header(text, folder), [float(x) for T in poses for x in T.T.ravel()])
    assert len(lines) == len(poses)
    return lines


def test_rows_beside_limits_are_no_farther_than_those(tmp_path: Path) -> None:
    """The arm on two limits, and a pose with one of these joints a little beyond: few starts lead there."""
    arm, header = emitted("position-pitch", tmp_path)
    inside = np.array([0.719038452, -1.5, -1.207215037, -1.7])
    assert (inside[[1, 3]] == arm.LOWER[[1, 3]]).all()
    T = arm.forward(inside - np.array([0.0, 6.11e-5, 0.0, 0.0]))
    assert arm.solve(T).status == "LIMITS"
    (numbers,) = by_header("position-pitch", header, T[None], tmp_path)
    other = np.reshape(numbers[1:], (-1, arm.DOF + 2))[:, : arm.DOF]
    for q in (arm.solve(T, project=True).q, other):
        assert len(q) and cost(arm, q, T).max() <= cost(arm, inside, T)


@pytest.mark.parametrize("task", sampled(["pose", "position-pitch"], ["pose"]))
def test_the_header_projects_alike(task: str, tmp_path: Path) -> None:
    arm, header = emitted(task, tmp_path)
    poses = displaced(arm, 12)[1]
    poses = np.concatenate([poses, arm.forward(np.zeros((1, arm.DOF)))])
    lines = by_header(task, header, poses, tmp_path)
    for T, (status, *numbers) in zip(poses, lines, strict=True):
        rows = np.reshape(numbers, (-1, arm.DOF + 2))
        found = arm.solve(T, project=True)
        assert status == 0 and len(rows) == len(found)
        apart = np.abs(rows[:, None, : arm.DOF] - found.q).max(axis=2)
        assert apart.min(axis=0).max() < 1e-5  # both stop where the cost is flat to rounding
        assert np.abs(np.sort(rows[:, arm.DOF :], 0) - np.sort(found.off, 0)).max() < 1e-6
