"""The oracle: Pinocchio on the file's own text, with mimic joints, locks and odd files."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest
from tests.support.fake_arms import JOINTS, six_axis_oracle, six_axis_urdf, tree_of

from ikgen.errors import BadDescriptionError, UnknownNameError
from ikgen.importers.urdf.joint_limits import turning_limits
from ikgen.kinematics.forward import row_constant
from ikgen.model.chain import PRISMATIC, REVOLUTE, ActuatedJoint
from ikgen.model.dh import Angle, DHChain, DHRow, Length
from ikgen.model.joint_tree import Limits
from ikgen.verify.oracle import PinocchioOracle, oracle_from_dh

MIMIC = """<?xml version="1.0" encoding="utf-8"?>
<robot name="m"><link name="world"/>
<link name="b"/><link name="l1"/><link name="l2"/><link name="l3"/>
<link name="side"/>
<joint name="float" type="floating"><parent link="world"/><child link="b"/></joint>
<joint name="aside" type="spherical"><parent link="l1"/><child link="side"/></joint>
<joint name="j1" type="continuous"><parent link="b"/><child link="l1"/><axis xyz="0 0 2"/></joint>
<joint name="j2" type="revolute"><parent link="l1"/><child link="l2"/><origin xyz="1 0 0"/>
  <axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="-3" velocity="1"/>
  <mimic joint="j1" multiplier="2" offset="0.1"/></joint>
<joint name="j3" type="continuous"><parent link="l2"/><child link="l3"/><origin xyz="1 0 0"/>
  <axis xyz="0 0 -1"/><mimic joint="j2" multiplier="-0.5"/></joint>
</robot>"""


def planar(angles: list[float]) -> np.ndarray:
    """Tip (x, y, heading) of unit links with joints before each of them but the tip's."""
    a = np.cumsum(angles)
    return np.array([math.cos(a[0]) + math.cos(a[1]), math.sin(a[0]) + math.sin(a[1]), a[2]])


def test_mimic_joints_follow_the_file() -> None:
    oracle = PinocchioOracle(tree_of(MIMIC), "b", "l3", ["j1"])
    assert oracle.dof == 1 and oracle.revolute.tolist() == [True]
    assert np.isnan(oracle.lower[0])
    assert any("effort -3" in note for note in oracle.notes)
    for q in (-2.0, 0.0, 0.3, 3.0):
        second = 2 * q + 0.1
        x, y, heading = planar([q, second, 0.5 * second])
        T = oracle.forward(np.array([q]))
        assert T[:2, 3] == pytest.approx([x, y], abs=1e-14)
        assert T[:2, 0] == pytest.approx([math.cos(heading), math.sin(heading)], abs=1e-14)


def test_prefixes_that_nothing_declares_are_left_alone() -> None:
    old = MIMIC.replace(
        '<link name="l1"/>', "<link name='l1'><sensor:camera><link/></sensor:camera></link>"
    )
    q = np.array([0.4])
    same = [PinocchioOracle(tree_of(text), "b", "l3", ["j1"]).forward(q) for text in (MIMIC, old)]
    assert np.array_equal(*same)


def test_comments_may_hold_what_xml_forbids() -> None:
    odd = MIMIC.replace('<link name="l1"/>', '<link name="l1"/><!-- a -- <link/>\n --->')
    q = np.array([0.4])
    same = [PinocchioOracle(tree_of(text), "b", "l3", ["j1"]).forward(q) for text in (MIMIC, odd)]
    assert np.array_equal(*same)


def test_locked_driver_sets_its_mimic_joints() -> None:
    oracle = PinocchioOracle(tree_of(MIMIC), "b", "l2", [], {"j1": 0.4})
    assert oracle.forward(np.zeros((1, 0)))[0, :2, 0] == pytest.approx(
        [math.cos(1.3), math.sin(1.3)]
    )


def test_what_follows_nothing_that_moves_stands_at_zero() -> None:
    still = PinocchioOracle(tree_of(MIMIC), "b", "l2", [])
    T = still.forward(np.zeros((1, 0)))[0]
    assert T[:2, 0] == pytest.approx([np.cos(0.1), np.sin(0.1)]) and T[0, 3] == pytest.approx(1.0)


def test_base_below_the_tip_and_a_lock() -> None:
    tree = tree_of(six_axis_urdf())
    down = PinocchioOracle(tree, "l0", "tip", ["j2", "j4"], {"j1": 0.3, "j3": -0.7})
    up = PinocchioOracle(tree, "tip", "l0", ["j4", "j2"], {"j1": 0.3, "j3": -0.7})
    q = np.random.default_rng(0).uniform(-3, 3, (20, 2))
    product = down.forward(q) @ up.forward(q[:, ::-1])
    assert np.abs(product - np.eye(4)).max() < 1e-14
    T, J = up.screws.forward_and_jacobian(q)
    assert np.abs(T - up.forward(q)).max() < 1e-14
    assert np.abs(J - up.jacobian(q)).max() < 1e-14


def test_jacobian_is_the_derivative() -> None:
    oracle, h = six_axis_oracle(), 1e-6
    q = np.random.default_rng(1).uniform(-3, 3, 6)
    J, T = oracle.jacobian(q), oracle.forward(q)
    for k, step in enumerate(h * np.eye(6)):
        dT = (oracle.forward(q + step) - oracle.forward(q - step)) / (2 * h)
        spin = dT[:3, :3] @ T[:3, :3].T
        numeric = [*dT[:3, 3], spin[2, 1], spin[0, 2], spin[1, 0]]
        assert J[:, k] == pytest.approx(numeric, abs=1e-8)


def test_screws_equal_pinocchio() -> None:
    oracle = six_axis_oracle()
    q = np.random.default_rng(2).uniform(-3, 3, (50, 6))
    T, J = oracle.screws.forward_and_jacobian(q)
    assert np.abs(T - oracle.forward(q)).max() < 1e-14
    assert np.abs(J - oracle.jacobian(q)).max() < 1e-14


def test_files_that_pinocchio_refuses() -> None:
    q = np.random.default_rng(3).uniform(-2, 2, (5, 6))
    odd = PinocchioOracle(tree_of(six_axis_urdf(effort=-1)), "l0", "tip", JOINTS)
    assert np.array_equal(odd.forward(q), six_axis_oracle().forward(q))
    assert len(odd.notes) == 5
    assert six_axis_oracle().notes == ()


def test_thousands_of_joints_in_a_row() -> None:
    count = 12_000
    joints = "".join(
        f'<link name="b{k}"/><joint name="f{k}" type="fixed"><origin xyz="0 0 0.001"/>'
        f'<parent link="{"tip" if k == 0 else f"b{k - 1}"}"/><child link="b{k}"/></joint>'
        for k in range(count)
    )
    text = six_axis_urdf().replace("</robot>", f"{joints}</robot>")
    oracle = PinocchioOracle(tree_of(text), "l0", f"b{count - 1}", JOINTS)
    T = six_axis_oracle().forward(np.ones(6))
    assert np.abs(oracle.forward(np.ones(6))[:3, 3] - T[:3, 3] - 12.0 * T[:3, 2]).max() < 1e-9


def test_limits_that_stand_for_none() -> None:
    text = six_axis_urdf().replace('lower="-2.9"', 'lower="-999999"').replace('"2.9"', '"999999"')
    oracle = PinocchioOracle(tree_of(text), "l0", "tip", JOINTS)
    assert (oracle.lower[0], oracle.upper[0]) == (-math.inf, math.inf)
    assert (oracle.lower[1], oracle.upper[1]) == (-2.0, 2.0)


@pytest.mark.parametrize(
    ("stated", "taken"),
    [
        ((-2.9, 999999), (-2.9, 4.0 * math.pi)),
        ((-1e9, 0.3), (-4.0 * math.pi, 0.3)),
        ((0.2, 1e16), (0.2, 0.2 + 4.0 * math.pi)),
        ((-1e9, -2.0), (-2.0 - 4.0 * math.pi, -2.0)),
    ],
)
def test_a_limit_that_stands_for_none_leaves_the_other(
    stated: tuple[float, float], taken: tuple[float, float]
) -> None:
    limits = f'lower="{stated[0]}" upper="{stated[1]}"'
    text = six_axis_urdf().replace('lower="-2.9" upper="2.9"', limits)
    oracle = PinocchioOracle(tree_of(text), "l0", "tip", JOINTS)
    assert (oracle.lower[0], oracle.upper[0]) == taken
    read, _ = turning_limits(*stated)
    assert (read.lower, read.upper) == taken


def test_unknown_names_and_broken_text() -> None:
    tree = tree_of(six_axis_urdf())
    with pytest.raises(UnknownNameError, match="tipp"):
        PinocchioOracle(tree, "l0", "tipp", JOINTS)
    with pytest.raises(UnknownNameError, match="j7"):
        PinocchioOracle(tree, "l0", "tip", [*JOINTS, "j7"])
    with pytest.raises(BadDescriptionError, match="not XML"):
        PinocchioOracle(tree_of("<robot"), "l0", "tip", JOINTS)


def dh_chain() -> DHChain:
    """A revolute and a prismatic row with a lift before them."""
    zero, none = Angle(0.0, Fraction(0)), Length(0.0, None)
    quarter = Angle(math.pi / 2, Fraction(1, 2))
    rows = (
        DHRow("j1", REVOLUTE, zero, none, Length(0.2, "d_1"), zero, 0, -1.0, quarter),
        DHRow("j2", PRISMATIC, quarter, Length(0.3, "a_1"), none, quarter, 1,
              1.0, Length(0.05, "o_2")),
    )  # fmt: skip
    joints = (
        ActuatedJoint("j1", REVOLUTE, Limits(-1, 2)),
        ActuatedJoint("j2", PRISMATIC, Limits(0, 1)),
    )
    base, tip = np.eye(4), np.eye(4)
    base[2, 3], tip[0, 3] = 1.0, 0.1
    frames = (base @ row_constant(rows[0]), row_constant(rows[1]), tip)
    return DHChain("dh", "base", "tip", joints, rows, base, tip, frames)


def matrix(axis: str, angle: float = 0.0, shift: float = 0.0) -> np.ndarray:
    """Rotation about and translation along x or z."""
    c, s, T = math.cos(angle), math.sin(angle), np.eye(4)
    i, j, k = (1, 2, 0) if axis == "x" else (0, 1, 2)
    T[i, i], T[i, j], T[j, i], T[j, j], T[k, 3] = c, -s, s, c, shift
    return T


def test_dh_rows() -> None:
    oracle = oracle_from_dh(dh_chain())
    half = math.pi / 2
    for q in ([0.0, 0.0], [0.7, 0.4], [-2.0, 1.0]):
        expected = (
            matrix("z", shift=1.0) @ matrix("z", -q[0] + half, 0.2)
            @ matrix("x", half, 0.3) @ matrix("z", half, q[1] + 0.05) @ matrix("x", shift=0.1)
        )  # fmt: skip
        assert np.abs(oracle.forward(np.array(q)) - expected).max() < 1e-14
    assert oracle.revolute.tolist() == [True, False]
    assert oracle.upper.tolist() == [2, 1]


def test_link_and_joint_of_one_name() -> None:
    text = six_axis_urdf().replace('"j4"', '"tip"').replace('"flange"', '"l6"')
    joints = [*JOINTS[:3], "tip", *JOINTS[4:]]
    q = np.random.default_rng(4).uniform(-2, 2, (5, 6))
    oracle = PinocchioOracle(tree_of(text), "l0", "tip", joints)
    assert np.array_equal(oracle.forward(q), six_axis_oracle().forward(q))


def test_no_moving_joint() -> None:
    oracle = PinocchioOracle(tree_of(six_axis_urdf()), "l6", "tip", [])
    assert oracle.jacobian(np.zeros((2, 0))).shape == (2, 6, 0)
    assert oracle.screws.forward(np.zeros((1, 0)))[0, 2, 3] == pytest.approx(0.1)


def test_mimic_circle() -> None:
    text = MIMIC.replace('<axis xyz="0 0 2"/>', '<axis xyz="0 0 1"/><mimic joint="j3"/>')
    with pytest.raises(BadDescriptionError, match="circle"):
        PinocchioOracle(tree_of(text), "b", "l3", [])
