"""What the MoveIt plugin reads of robot models and messages, for an arm written by hand."""

from __future__ import annotations

import subprocess
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.moveit_group_program import compiled_beside_group

Array = NDArray[np.float64]

CODE = r"""
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include "ikgen_moveit/messages.hpp"
#include "src/robot_model.cpp"
using namespace moveit::core;
void print(const Eigen::Isometry3d& T) {
  for (int i = 0; i < 16; ++i) std::printf("%.17g ", T.matrix()(i / 4, i % 4));
}
int place(char** argv) {
  const auto link = [&](const char* name, const char* type, double low, double high) {
    const auto kind = type[0] == 'r' ? JointModel::REVOLUTE : JointModel::FIXED;
    return JointModel(name, kind, Eigen::Vector3d::UnitZ(), {low, high, low < high});
  };
  const Eigen::Isometry3d one = ik::turned(0.0, 1.0), none = Eigen::Isometry3d::Identity();
  const bool fixed = argv[1] == std::string("fixed");
  RobotModel model("world", fixed ? JointModel::FIXED : JointModel::FLOATING, "cell");
  model.add_link("base", "cell", link("stand", "fixed", 0.0, 0.0), ik::turned(0.7, 0.5));
  model.add_link("upper", "base", link("first", "revolute", 0.0, 0.0), none);
  const Eigen::Isometry3d second = ik::turned(0.0, std::atof(argv[4]));
  model.add_link("lower", "upper", link("second", "revolute", -0.5, 5.0), second);
  model.add_link("wrist", "lower", link(argv[5], "revolute", std::atof(argv[6]), std::atof(argv[7])), one);
  model.add_link("tip", "wrist", link("end", "fixed", 0.0, 0.0), ik::turned(0.0, 0.5));
  model.add_link("tool", "tip", link("flange", "fixed", 0.0, 0.0), ik::turned(-1.1, 0.1));
  if (argv[5] != std::string("third"))
    model.add_link("flag", "base", link("third", "revolute", 0.0, 0.0), none);
  try {
    const auto found = ikgen_moveit::place_chain(model, argv[2], argv[3]);
    print(found.T_base_group_base);
    print(found.T_group_tip_tip);
    const auto &low = found.limits.lower, &high = found.limits.upper;
    std::printf("%.17g %.17g %.17g %.17g\n", low[0], low[1], high[0], high[1]);
  } catch (const std::exception& error) {
    std::printf("%s\n", error.what());
  }
  return 0;
}
int main(int argc, char** argv) {
  if (argv[1] == std::string("group")) {
    std::vector<std::string> names(argv + 2, argv + argc);
    std::printf("%s\n", ikgen_moveit::misfit(JointModelGroup("arm", names)).c_str());
    return 0;
  }
  if (argv[1] != std::string("message")) return place(argv);
  double x[7];
  for (int i = 0; i < 7; ++i) x[i] = std::atof(argv[2 + i]);
  const auto T = ikgen_moveit::from_message({{x[0], x[1], x[2]}, {x[3], x[4], x[5], x[6]}});
  if (!T) return 0;
  print(*T);
  const auto back = ikgen_moveit::to_message(*T);
  const auto &p = back.position;
  const auto &r = back.orientation;
  std::printf("%.17g %.17g %.17g %.17g %.17g %.17g %.17g\n", p.x, p.y, p.z, r.x, r.y, r.z, r.w);
}
"""


@pytest.fixture(scope="module", params=["pose", "position"])
def program(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    task = f'-DTASK="{request.param}"'
    folder = tmp_path_factory.mktemp(request.param)
    return compiled_beside_group(CODE, folder, task)


def run(program: Path, *words: object) -> str:
    command = [str(program), *map(str, words)]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()


def placed(program: Path, base: str = "base", tip: str = "tip", *, root: str = "fixed", length: float = 1.0,
           last: str = "third", low: float = 0.0, high: float = 0.0) -> str:  # fmt: skip
    """What comes of a model whose first link is `length` m, and whose last joint has a name and limits."""
    return run(program, root, base, tip, length, last, low, high)


def numbers(text: str) -> tuple[Array, Array, list[float]]:
    """Both poses, and the limits."""
    values = [float(word) for word in text.split()]
    return np.reshape(values[:16], (4, 4)), np.reshape(values[16:32], (4, 4)), values[32:]


def turned(angle: float, x: float) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0, c * x], [s, c, 0, s * x], [0, 0, 1, 0], [0, 0, 0, 1]])


def test_frames_may_be_any_that_are_fixed_to_the_ends(program: Path) -> None:
    T_base_cell = np.linalg.inv(turned(0.7, 0.5))
    for base, expected in (("base", np.eye(4)), ("cell", T_base_cell), ("world", T_base_cell)):
        T_base_group_base, T_group_tip_tip, _ = numbers(placed(program, base))
        np.testing.assert_allclose(T_base_group_base, expected, atol=1e-15)
        np.testing.assert_array_equal(T_group_tip_tip, np.eye(4))
    answer = placed(program, tip="tool")
    if program.parent.name.startswith("position"):
        assert answer.endswith(
            "leaves the tip's orientation open: the group's tip 'tool' has to be at 'tip'"
        )
    else:
        np.testing.assert_allclose(numbers(answer)[1], np.linalg.inv(turned(-1.1, 0.1)), atol=1e-15)


def test_other_frames_are_refused(program: Path) -> None:
    assert placed(program, "world", root="floating") == "the robot model has no link 'world'"
    assert placed(program, tip="nowhere") == "the robot model has no link 'nowhere'"
    assert placed(program, "lower") == (
        "the joint 'second' moves between 'base' and 'lower': they have to be rigidly connected"
    )


def test_limits_are_those_of_both_by_whatever_joint_of_the_group(program: Path) -> None:
    """The third joint has -2 q + 0.1 of the second's value q."""
    assert numbers(placed(program))[2] == [-3.0, -0.5, 3.0, 2.0]
    found = numbers(placed(program, low=-1.9, high=0.7))[2]
    assert found == pytest.approx([-3.0, -0.3, 3.0, 1.0], abs=1e-15)
    assert numbers(placed(program, low=-9.0, high=9.0))[2] == [-3.0, -0.5, 3.0, 2.0]
    assert placed(program, low=2.0, high=3.0) == (
        "no value of the joint 'third' is inside the limits of both the robot model and the description"
    )


def test_another_chain_is_refused(program: Path) -> None:
    assert numbers(placed(program, length=1.000009))
    answer = placed(program, length=1.00002)
    assert "its tip is 0.02 mm and 0 rad away; generate the solver again" in answer
    assert placed(program, last="wrist_roll").startswith(
        "the joint 'wrist_roll' is between base and tip"
    )


def test_groups_have_these_joints_in_this_order(program: Path) -> None:
    wanted = "this solver needs exactly first, second, third, in this order"
    assert run(program, "group", "first", "second", "third") == ""
    for names in (["second", "first", "third"], ["first", "second"], []):
        given = ", ".join(names) or "none"
        assert run(program, "group", *names) == f"the group 'arm' has the joints {given}; {wanted}"


def test_messages_are_poses_where_their_quaternion_has_unit_length(program: Path) -> None:
    c, s = np.cos(0.35), np.sin(0.35)
    message = np.array([0.1, -0.2, 0.3, 0.0, 0.0, s, c])
    for length in (1.0, 1.009, 0.991):
        values = np.array(
            run(program, "message", *message[:3], *(length * message[3:])).split(), float
        )
        expected = turned(0.7, 0.0)
        expected[:3, 3] = message[:3]
        np.testing.assert_allclose(values[:16].reshape(4, 4), expected, atol=1e-15)
        np.testing.assert_allclose(values[16:], message, atol=1e-15)
    for bad in (1.02 * message, 0.98 * message, 0.0 * message, message * np.nan):
        assert run(program, "message", *message[:3], *bad[3:]) == ""
    assert run(program, "message", "inf", *message[1:]) == ""
