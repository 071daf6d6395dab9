"""Modified DH rows of made chains: forward kinematics, form, invariance under rewriting."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.support.chains import (
    chain_forward,
    make_chain,
    random_chain,
    rewritten,
    rotation,
    translation,
)

from ikgen.errors import UnknownNameError, UsageError
from ikgen.kinematics.classify import parallel_to_previous
from ikgen.kinematics.forward import (
    dh_forward,
    file_forward,
    file_jacobian,
    file_slopes,
)
from ikgen.kinematics.modified_dh import to_dh
from ikgen.model.chain import ActuatedJoint, Chain, ChainAxis
from ikgen.model.dh import DHChain
from ikgen.model.joint_tree import Limits

TIGHT = {"angle_tolerance": 1e-8, "length_tolerance": 1e-9}
X, Y, Z = [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]


def assert_same_pose(chain: Chain, dh: DHChain, tolerance: float = 1e-11) -> None:
    """Both forms of `dh` agree with `chain` at random configurations, one by one and at once."""
    q = np.random.default_rng(1).uniform(-3, 3, (8, chain.dof))
    expected = chain_forward(chain, q)
    np.testing.assert_allclose(file_forward(dh, q), expected, atol=1e-12, rtol=0)
    np.testing.assert_allclose(dh_forward(dh, q), expected, atol=tolerance, rtol=0)
    np.testing.assert_allclose(dh_forward(dh, q[0]), expected[0], atol=tolerance, rtol=0)
    np.testing.assert_allclose(chain_forward(chain, q[0]), expected[0], atol=1e-14, rtol=0)


def assert_form(dh: DHChain) -> None:
    """The promises of the form: alpha in [0, pi), a >= 0, zero constants at both ends."""
    first, last = dh.rows[0], dh.rows[-1]
    assert (first.alpha.value, first.a.value, first.d.value) == (0.0, 0.0, 0.0)
    assert last.d.value == 0.0
    for row in dh.rows:
        assert 0.0 <= row.alpha.value < math.pi - 1e-9
        assert row.a.value >= 0.0
        assert (row.a.name is None) == (row.a.value == 0.0)
        assert row.theta.value == 0.0 if row.revolute else row.d.value == 0.0
    for matrix in (dh.X_base, dh.X_tip, *dh.file_frames):
        assert not matrix.flags.writeable


def signature(dh: DHChain) -> tuple[Counter[float], Counter[float]]:
    """Twists (an acute one stands for its supplement) and lengths, without order or sign."""
    alphas = [min(row.alpha.value, math.pi - row.alpha.value) for row in dh.rows]
    lengths = [abs(length.value) for row in dh.rows for length in (row.a, row.d)]
    return Counter(round(v, 7) for v in alphas), Counter(round(v, 7) for v in lengths)


@st.composite
def chains(draw: st.DrawFn, kinds: str = "RRRP") -> Chain:
    n = draw(st.integers(1, 10))
    moves = "".join(draw(st.lists(st.sampled_from(kinds), min_size=n, max_size=n)))
    relations = "".join(draw(st.lists(st.sampled_from("gpasmo"), min_size=n, max_size=n)))
    return random_chain(np.random.default_rng(draw(st.integers(0, 2**32))), moves, relations)


@given(chains())
@settings(max_examples=60, deadline=None)
def test_rows_reproduce_any_chain(chain: Chain) -> None:
    dh = to_dh(chain, **TIGHT)
    assert_form(dh)
    assert_same_pose(chain, dh)
    assert max(dh.deviation) < 1e-11
    assert not dh.snaps


def test_twists_share_a_name_within_the_tolerance_only() -> None:
    # two twists of this chain are 3e-6 rad apart
    chain = random_chain(np.random.default_rng(3292), "RRRRPRPRR", "ggpgmsapm")
    exact, shared = to_dh(chain, **TIGHT), to_dh(chain, angle_tolerance=1e-4)
    assert max(exact.deviation) < 1e-11 and not exact.snaps
    assert exact.rows[3].alpha.name == "alpha_3" and shared.rows[3].alpha.name == "alpha_1"


@given(chains(), st.integers(0, 2**32))
@settings(max_examples=50, deadline=None)
def test_other_frames_give_the_same_geometry(chain: Chain, seed: int) -> None:
    other, signs = rewritten(chain, np.random.default_rng(seed))
    q = np.random.default_rng(2).uniform(-3, 3, (4, chain.dof))
    np.testing.assert_allclose(
        chain_forward(other, q * signs), chain_forward(chain, q), atol=1e-12, rtol=0
    )
    dh, dh_other = to_dh(chain, **TIGHT), to_dh(other, **TIGHT)
    np.testing.assert_allclose(
        dh_forward(dh_other, q * signs), dh_forward(dh, q), atol=1e-10, rtol=0
    )
    alphas, lengths = signature(dh)
    alphas_other, lengths_other = signature(dh_other)
    assert alphas == alphas_other
    sliding = sum(joint.kind == "prismatic" for joint in chain.joints)
    if sliding == 0:
        assert lengths == lengths_other
    if sliding <= 2:  # beyond, the search for their lines is not exhaustive
        assert lengths[0.0] == lengths_other[0.0]


@given(chains(kinds="RP"), st.integers(0, 2**32))
@settings(max_examples=25, deadline=None)
def test_rounded_files_keep_their_structure(chain: Chain, seed: int) -> None:
    rng = np.random.default_rng(seed)
    noisy = Chain(
        chain.robot,
        chain.base_link,
        chain.tip_link,
        chain.joints,
        tuple(
            ChainAxis(
                axis.name,
                axis.kind,
                axis.T_prev_axis @ rotation(list(rng.normal(size=3)), 3e-6),
                axis.axis,
                axis.driver,
            )
            for axis in chain.axes
        ),
        chain.T_last_tip,
    )
    dh, exact = to_dh(noisy, angle_tolerance=5e-5), to_dh(chain, **TIGHT)
    assert_form(dh)
    np.testing.assert_allclose(
        [row.alpha.value for row in dh.rows], [row.alpha.value for row in exact.rows], atol=1e-4
    )
    assert [parallel_to_previous(row) for row in dh.rows] == [
        parallel_to_previous(row) for row in exact.rows
    ]
    q = np.random.default_rng(3).uniform(-3, 3, (8, chain.dof))
    np.testing.assert_allclose(file_forward(dh, q), chain_forward(noisy, q), atol=1e-11)
    assert max(dh.deviation) < 5e-3


def test_antiparallel_axes_become_parallel() -> None:
    chain = make_chain("RR", [np.eye(4), translation(0.5, 0, 0.1)], [Z, [0, 0, -1]])
    dh = to_dh(chain)
    assert dh.rows[1].alpha.exact == 0
    assert [row.scale for row in dh.rows] == [1.0, -1.0]
    assert dh.rows[1].a.value == 0.5
    assert_same_pose(chain, dh)


@pytest.mark.parametrize("kinds", ["RR", "RP", "PR", "PP"])
def test_two_joints_on_one_line(kinds: str) -> None:
    chain = make_chain(kinds, [translation(0.1, 0.2, 0.3), translation(0, 0, 0.2)], [Z, Z])
    dh = to_dh(chain)
    assert all(row.a.value == row.d.value == row.alpha.value == 0.0 for row in dh.rows)
    assert all(row.theta.value == row.offset.value == 0.0 for row in dh.rows)
    np.testing.assert_array_equal(dh.X_base, translation(0.1, 0.2, 0.5))
    np.testing.assert_array_equal(dh.X_tip, np.eye(4))
    assert_same_pose(chain, dh)


def test_single_joint_is_all_constants() -> None:
    tool = translation(0.1, 0, 0.4)
    dh = to_dh(make_chain("R", [translation(0, 0, 0.3)], [[0, 0, -1]], tool))
    assert dh.rows[0].scale == -1.0
    np.testing.assert_array_equal(dh.X_base[:3, :3], np.eye(3))
    assert dh.rows[0].offset == type(dh.rows[0].offset)(0.0, Fraction(0))


def test_stanford_arm_slides_through_the_wrist() -> None:
    chain = make_chain(
        "RRPRRR",
        [
            translation(0, 0, 0.4),
            translation(0, 0.15, 0),
            translation(0, 0, 0.3),
            translation(0, 0, 0.2),
            np.eye(4),
            np.eye(4),
        ],
        [Z, Y, Z, Z, Y, Z],
        translation(0, 0, 0.1),
    )
    dh = to_dh(chain)
    assert [row.a.value for row in dh.rows] == [0.0] * 6
    assert [abs(row.d.value) for row in dh.rows] == [0.0, 0.15, 0.0, 0.0, 0.0, 0.0]
    assert [row.theta.value for row in dh.rows] == [0.0] * 6
    assert_same_pose(chain, dh)


def test_gantry_has_no_lengths() -> None:
    frames = [translation(0.1, 0.2, 0.3), translation(0.4, 0, 0), translation(0, 0.3, 0.2)]
    dh = to_dh(make_chain("PPP", frames, [X, Y, Z]))
    assert all(row.a.value == row.offset.value == 0.0 for row in dh.rows)
    assert [row.alpha.exact for row in dh.rows] == [0, Fraction(1, 2), Fraction(1, 2)]


def test_mimic_joint_drives_its_row() -> None:
    joints = (ActuatedJoint("q0", "revolute", make_chain("R", [np.eye(4)], [Z]).joints[0].limits),)
    step = translation(0.5, 0, 0)
    axes = (
        ChainAxis("first", "revolute", np.eye(4), np.array(Z), 0),
        ChainAxis("second", "revolute", step, np.array([0.0, 0.0, -1.0]), 0, 2.0, 0.3),
    )
    chain = Chain("coupled", "base", "tip", joints, axes, translation(0.2, 0, 0))
    dh = to_dh(chain)
    assert [row.scale for row in dh.rows] == [1.0, -2.0]
    assert dh.rows[1].offset.value == pytest.approx(-0.3)
    assert_same_pose(chain, dh)


def test_equal_lengths_share_a_name() -> None:
    chain = make_chain(
        "RRR", [np.eye(4), translation(0.25, 0, 0), translation(-0.250003, 0, 0)], [Z, Z, Z]
    )
    dh = to_dh(chain)
    assert [row.a.name for row in dh.rows] == [None, "a_1", "a_1"]
    assert {snap.what for snap in dh.snaps} == {"a_2"}
    assert 1e-6 < dh.deviation[0] < 1e-5


def test_offsets_stay_literal_where_that_is_exact() -> None:
    turned = translation(0.35, 0, 0) @ rotation(Z, 1.57)
    dh = to_dh(make_chain("RRR", [np.eye(4), turned, translation(0.27, 0, 0)], [Z, Z, Z]))
    assert dh.rows[1].offset.value == 1.57
    assert max(dh.deviation) < 1e-12


def test_names_follow_the_textbook() -> None:
    skew = translation(0.1, 0, 0.2) @ rotation(X, 0.7)
    dh = to_dh(make_chain("RRRR", [np.eye(4), skew, skew, skew], [Z, Z, Z, Z]))
    assert [row.alpha.name for row in dh.rows] == [None, "alpha_1", "alpha_1", "alpha_1"]
    assert [row.a.name for row in dh.rows] == [None, "a_1", "a_1", "a_1"]
    assert [row.d.name for row in dh.rows] == [None, "d_2", "d_2", None]


@given(chains(), st.integers(0, 2**32))
@settings(max_examples=40, deadline=None)
def test_jacobian_is_the_derivative(chain: Chain, seed: int) -> None:
    dh = to_dh(chain)
    q = np.random.default_rng(seed).uniform(-3, 3, chain.dof)
    J, h = file_jacobian(dh, q), 1e-6
    R = file_forward(dh, q)[:3, :3]
    for k in range(chain.dof):
        step = np.eye(chain.dof)[k] * h
        slope = (file_forward(dh, q + step) - file_forward(dh, q - step)) / (2 * h)
        np.testing.assert_allclose(file_slopes(dh, q)[..., k], slope[:3], atol=1e-7)
        np.testing.assert_allclose(J[:3, k], slope[:3, 3], atol=1e-7)
        W = slope[:3, :3] @ R.T
        np.testing.assert_allclose(J[3:, k], [W[2, 1], W[0, 2], W[1, 0]], atol=1e-7)
    np.testing.assert_array_equal(file_jacobian(dh, np.stack([q, q]))[1], J)


def test_refusals() -> None:
    chain = make_chain("R", [np.eye(4)], [Z])
    with pytest.raises(UnknownNameError):
        to_dh(chain, free=["nobody"])
    assert to_dh(chain, free=["q0"]).free == ("q0",)
    with pytest.raises(UsageError):
        to_dh(Chain("still", "base", "tip", (), (), np.eye(4)))


@pytest.mark.parametrize(
    ("reach", "off"), [(0.5, 2e-6), (20.0, 8e-5), (math.inf, 4e-6), (1e9, 1.2e-4)]
)
def test_deviation_is_that_at_the_ends_of_a_rail(reach: float, off: float) -> None:
    """Of slides that the file has 4e-6 rad off square the tool is the farther off the farther they go."""
    turned, links = rotation(Z, 4e-6), [translation(0.1, 0, 0), translation(0.3, 0, 0)]
    chain = make_chain("PPRR", [np.eye(4), turned, *links], [X, Y, Z, Z])
    limits = Limits(-reach, reach)
    slides = [replace(joint, limits=limits) for joint in chain.joints[:2]]
    dh = to_dh(replace(chain, joints=(*slides, *chain.joints[2:])))
    assert dh.snaps
    assert 0.8 * off < dh.deviation[0] < 1.3 * off + 2e-6
