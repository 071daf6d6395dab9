"""Chains whose configurations are the last axis of all arrays."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.kinematics.test_twist_links import SLIDES
from tests.support.rounded_arms import spherical_wrist, three_parallel

from ikgen.kinematics.forward import file_forward
from ikgen.kinematics.modified_dh import to_dh
from ikgen.kinematics.rigid import exact_cos_sin
from ikgen.kinematics.twist_links import TwistLink, twist_chain
from ikgen.model.chain import Chain
from ikgen.model.dh import DHChain
from ikgen.runtime.python.arm.chain_kinematics import chain_of, jacobian
from ikgen.runtime.python.arm.lane_chain import LaneChain, Link, lane_jacobian, sines, turned, walk
from ikgen.runtime.python.arm.lane_tasks import PoseLanes

CHAINS = (three_parallel(skew=1e-4), spherical_wrist(), SLIDES)


def lanes(dh: DHChain, direct: bool) -> LaneChain:
    twisted = twist_chain(dh)
    links = twisted.links
    return LaneChain(
        PoseLanes(1.0),
        twisted.first,
        tuple(one.driver for one in links),
        np.array([[one.scale] for one in links]),
        np.array([[one.offset] for one in links]),
        tuple(map(link, links)),
        twisted.last,
        direct,
    )


def link(one: TwistLink) -> Link:
    return (one.revolute, *exact_cos_sin(one.turn), one.x, one.y, *exact_cos_sin(one.twist))


@pytest.mark.parametrize("chain", CHAINS)
@pytest.mark.parametrize("direct", [False, True])
def test_tips_and_jacobians_are_the_files(chain: Chain, direct: bool) -> None:
    dh = to_dh(chain)
    if direct:
        rows = [replace(row, scale=1.0) for row in dh.rows]
        dh = replace(dh, rows=tuple(rows))
    motions = tuple((r.driver, r.revolute, r.scale, r.offset.value) for r in dh.rows)
    plain = chain_of(np.array(dh.file_frames), motions, dh.dof)
    q = np.random.default_rng(2).uniform(-3, 3, (dh.dof, 50))
    lane = lanes(dh, direct)
    values = lane.changes(q) + lane.offset
    tip, axes = walk(lane, values, sines(values))
    J = lane_jacobian(lane, tip, axes, dh.dof)
    for k in range(50):
        assert np.abs(tip[:, :, k] - file_forward(dh, q[:, k])[:3]).max() < 3e-14
        assert np.abs(J[:, :, k].T - jacobian(plain, q[:, k])).max() < 1e-5


def test_sines_have_all_digits() -> None:
    for most in (0.05, 20.0, 1e6):
        angles = np.random.default_rng(3).uniform(-most, most, 20000)
        c, s = sines(angles)
        assert max(np.abs(c - np.cos(angles)).max(), np.abs(s - np.sin(angles)).max()) < 1e-15
    angles = np.linspace(-0.05, 0.05, 1001)
    c, s = turned((np.cos(1.0), np.sin(1.0)), angles)
    assert np.abs(c - np.cos(1.0 + angles)).max() < 1e-15
    assert np.abs(s - np.sin(1.0 + angles)).max() < 1e-15
