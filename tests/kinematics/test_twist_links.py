"""The file's own chain with four constants a link."""

from __future__ import annotations

import numpy as np
import pytest
from tests.support.chains import make_chain, rotation, translation
from tests.support.rounded_arms import X, Z, spherical_wrist, three_parallel

from ikgen.kinematics.forward import file_forward
from ikgen.kinematics.modified_dh import to_dh
from ikgen.kinematics.rigid import rotation_x, rotation_z
from ikgen.kinematics.twist_links import TwistChain, twist_chain
from ikgen.model.arrays import Array
from ikgen.model.chain import Chain

Y = [0.0, 1.0, 0.0]
SLIDES = make_chain(
    "PRPRP",
    [
        translation(0.1, 0.2, 0.3),
        rotation(Y, 0.4) @ translation(0.1, -0.3, 0.2),
        rotation(X, 1.5708) @ rotation(Z, 0.3),
        translation(0.2, 0.1, -0.4) @ rotation(Y, 1.5708),
        rotation(X, 1e-5) @ translation(0, 0.3, 0.1),
    ],
    [Z, Z, Z, X, Y],
    translation(0.1, 0.2, 0.3) @ rotation(Y, 0.7),
)


def pose(chain: TwistChain, q: np.ndarray) -> Array:
    T = chain.first
    for link in chain.links:
        value = link.scale * q[link.driver] + link.offset
        u, v = (value, 0.0) if link.revolute else (link.turn, value)
        step = np.eye(4)
        step[:3, :3] = rotation_z(u) @ rotation_x(link.twist)
        step[:3, 3] = rotation_z(u) @ [link.x, link.y, 0.0] + [0.0, 0.0, v]
        T = T @ step
    return T @ chain.last


@pytest.mark.parametrize("chain", [three_parallel(skew=1e-4), spherical_wrist(), SLIDES])
def test_the_pose_is_the_files(chain: Chain) -> None:
    dh = to_dh(chain)
    twisted = twist_chain(dh)
    for q in np.random.default_rng(1).uniform(-3, 3, (20, dh.dof)):
        assert np.abs(pose(twisted, q) - file_forward(dh, q)).max() < 2e-14


def test_only_the_last_frame_is_behind_the_last_motion() -> None:
    for chain in (spherical_wrist(), SLIDES):
        last = twist_chain(to_dh(chain)).links[-1]
        assert (last.x, last.y, last.twist) == (0.0, 0.0, 0.0)


def test_parallel_axes_have_short_steps() -> None:
    steps = [np.hypot(link.x, link.y) for link in twist_chain(to_dh(three_parallel())).links]
    assert max(steps) < 0.5
