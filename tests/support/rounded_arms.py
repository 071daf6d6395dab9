"""Arms as files write them: right angles in five digits."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from tests.support.chains import make_chain, rotation, translation

from ikgen.model.chain import Chain

X, Z = [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]


def three_parallel(right: float = 1.5708, *, skew: float = 0.0) -> Chain:
    """Axes 2 to 4 parallel, 4 and 5 and 5 and 6 meet; `skew` (m) parts the last two."""
    return make_chain(
        "RRRRRR",
        [
            translation(0, 0, 0.15),
            rotation(X, right),
            translation(-0.42, 0, 0),
            translation(-0.39, 0, 0.13),
            translation(0, -0.1, 0) @ rotation(X, right),
            translation(skew, 0.09, 0) @ rotation(X, -right),
        ],
        [Z] * 6,
        translation(0, 0, 0.08),
    )


def spherical_wrist(right: float = 1.5708, *, offset: float = 0.0) -> Chain:
    """Axes 2 and 3 parallel, 4 to 6 meet but for `offset` (m) along axis 5."""
    return make_chain(
        "RRRRRR",
        [
            translation(0, 0, 0.3),
            translation(0.05, 0, 0) @ rotation(X, right),
            translation(0.4, 0, 0),
            rotation(X, right) @ translation(0, 0, 0.35),
            rotation(X, -right) @ translation(0, 0, offset),
            rotation(X, right),
        ],
        [Z] * 6,
        translation(0, 0, 0.1),
    )


def meeting_shoulder(right: float = 1.5708, *, offset: float = 1e-6) -> Chain:
    """As `spherical_wrist`, axes 1 and 2 meet: with the wrist above them joint 1 is free, but for what the
    file rounds."""
    return make_chain(
        "RRRRRR",
        [
            translation(0, 0, 0.24),
            rotation(X, right),
            translation(0.256, 0, 0),
            rotation(X, right) @ translation(0, 0, 0.21),
            rotation(X, -right) @ translation(0, 0, offset),
            rotation(X, right),
        ],
        [Z] * 6,
        translation(0, 0, 0.144),
    )


def of_two_decimals() -> Chain:
    """Axes 2 to 4 parallel and 5 and 6 meet, but for angles in two decimals: milliradians off."""
    x, y, z = X, [0.0, 1.0, 0.0], Z
    return make_chain(
        "RRRRRR",
        [
            translation(0, 0, 0.1005),
            rotation(z, 3.14) @ rotation(x, 1.57),
            translation(0.18, 0, 0) @ rotation(z, 2.83) @ rotation(x, 3.14),
            translation(0.1888, 0, 0) @ rotation(z, -0.31) @ rotation(x, 3.14),
            translation(0.08, 0, 0) @ rotation(y, 1.57) @ rotation(x, -1.57),
            translation(0, -0.036, 0) @ rotation(x, 1.57),
        ],
        [z] * 6,
        np.eye(4),
    )


WRIST_BESIDE_THE_FIRST_AXIS = [
    [1.95893964831448, -1.5439391189238, 2.88112966288778, -0.198565722472938, -1.5138173931993,
     2.13207437578567],
    [0.859170610029200, -1.4425981186028, 2.98970662754615, -0.670602520955332, 1.57785549814427,
     2.38275874176806],
    [-2.67685711654693, -1.45346058843757, 2.62330731928202, -0.938200826081263, -1.57529709277002,
     -0.204896597453372],
]  # fmt: skip
"""Configurations of `of_two_decimals` where the last axis is nearly parallel to those of the elbow as well:
no more is left of its direction than the file is off."""

EXACT, IN_TEN_DIGITS = math.pi / 2, 1.570796327

FOLDED = [
    [-1.96033274450597, 0.66543809597274, -2.52372616827503, -2.50427844103334, 0.89406157205916,
     3.03630490120778],
    [-1.96032965443633, 0.66543355343915, -2.52370960393478, -2.50428732897959, 0.89407944782896,
     3.03629500742216],
    [-1.96033056596298, 0.66543328581914, -2.52370942073624, -2.50428670206727, 0.89407901978423,
     3.03629557192863],
]  # fmt: skip
"""Configurations of `meeting_shoulder` where two solutions meet on what is a continuum of the solved
geometry alone."""


def beside_the_wrist(count: int) -> NDArray[np.float64]:
    """Configurations of `three_parallel` with the wrist 10 to 60 times as far from straight as its file is
    off what is solved, and the elbow nearly straight: what the closed form takes for the hand's direction
    is wrong enough there to bring the elbow out of reach."""
    rng = np.random.default_rng(2)
    q = rng.uniform(-3.0, 3.0, (count, 6))
    q[:, 2] = rng.choice([-1.0, 1.0], count) * rng.uniform(0.05, 0.3, count)
    off = rng.choice([-1.0, 1.0], count) * rng.uniform(1e-4, 6e-4, count)
    q[:, 4] = rng.choice([0.0, math.pi], count) + off
    return q
