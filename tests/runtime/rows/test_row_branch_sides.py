"""Names of rows by where shoulder, elbow and wrist are."""

from __future__ import annotations

from math import pi
from typing import Any

import numpy as np
from numpy.typing import NDArray
from tests.support.chains import rotation, translation
from tests.support.given_rows import given_arm

from ikgen.runtime.python.arm.chain_kinematics import chain_of
from ikgen.runtime.python.rows.row_branches import branch_names

Array = NDArray[np.float64]
X = [1.0, 0.0, 0.0]


def arm(offset: float, ahead: float = 0.0) -> Any:
    """A column of 0.3 m, links of 0.5 and 0.4 m beside it, or ahead of it, and a wrist."""
    frames = [
        np.eye(4),
        translation(ahead, 0.0, 0.3) @ rotation(X, -pi / 2) @ translation(0.0, 0.0, offset),
        translation(0.5, 0.0, 0.0),
        translation(0.4, 0.0, 0.0) @ rotation([0.0, 1.0, 0.0], pi / 2),
        rotation(X, -pi / 2),
        rotation(X, pi / 2),
        translation(0.0, 0.0, 0.1),
    ]
    chain = chain_of(np.array(frames), tuple((k, True, 1.0, 0.0) for k in range(6)), 6)
    return given_arm(None, chain=chain, branch_kind="names", elbow_end=4)


def test_sides_are_those_of_the_links_in_their_plane() -> None:
    """By heights above the line from shoulder to wrist, and by where the wrist is from the column."""
    rng = np.random.default_rng(4)
    q = rng.uniform(-3.0, 3.0, (400, 6))
    for offset, ahead in ((0.0, 0.0), (0.2, 0.0), (0.0, 0.3)):
        seen = set()
        for row, name in zip(q, branch_names(arm(offset, ahead), q), strict=True):
            r = np.cumsum([0.0, 0.5 * np.cos(row[1]), 0.4 * np.cos(row[1] + row[2])])
            z = -np.cumsum([0.0, 0.5 * np.sin(row[1]), 0.4 * np.sin(row[1] + row[2])])
            above = (z[1] * r[2] - r[1] * z[2]) * np.sign(
                r[2]
            )  # over the line, times its length along r
            if min(abs(above), abs(r[2]), abs(r[2] + ahead), abs(np.sin(row[4]))) < 1e-3:
                continue
            shoulder, elbow, wrist = name.split(", ")
            assert elbow == ("elbow up" if above > 0.0 else "elbow down")
            seen.add((shoulder, r[2] + ahead > 0.0))
            assert wrist == (
                "wrist not flipped" if np.sin(row[4]) > 0.0 else "wrist flipped"
            ) or wrist == ("wrist flipped" if np.sin(row[4]) > 0.0 else "wrist not flipped")
            seen.add((wrist, np.sin(row[4]) > 0.0))
        assert len(seen) == 4  # one name for each side


def test_a_row_and_its_other_side_have_other_names() -> None:
    """The same elbow reached from behind: the column turned half around, all else mirrored."""
    q = np.random.default_rng(5).uniform(-1.2, 1.2, (50, 6))
    behind = q.copy()
    behind[:, 0] += pi
    behind[:, 1] = pi - q[:, 1]
    behind[:, 2] = -q[:, 2]
    for one, other in zip(*(branch_names(arm(0.0), rows) for rows in (q, behind)), strict=True):
        assert one.split(", ")[0] != other.split(", ")[0]
        assert one.split(", ")[1] == other.split(", ")[1]
