"""Arms whose motors move several joints."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray
from tests.support.redundant_arms import SHOULDER_ELBOW_WRIST, serial_urdf

__all__ = ["BELTS", "SCARA", "SCARA_JOINTS", "SIX", "SIX_JOINTS", "couple_options", "joint_values"]

Array = NDArray[np.float64]
Sources = Mapping[str, tuple[Mapping[str, float], float]]

SCARA_JOINTS = ("inner", "outer", "spline", "quill")
_TURN = (-2.6, 2.6)
SCARA = serial_urdf(
    "scara",
    (
        ("inner", "revolute", "0 0 1", "0 0 0.3", _TURN),
        ("outer", "revolute", "0 0 1", "0.4 0 0", (-2.4, 2.4)),
        ("spline", "prismatic", "0 0 -1", "0.3 0 0", (0.0, 0.2)),
        ("quill", "revolute", "0 0 1", "0 0 0", (-6.0, 6.0)),
    ),
)

BELTS: Sources = {
    "outer": ({"outer": 1.0, "inner": -1.0}, 0.1),
    "spline": ({"spline": 0.003, "quill": 0.0005}, 0.0),
    "quill": ({"quill": 0.5, "outer": 1.0}, 0.0),
}
"""The outer link is belted to the base, and the nut of the spline turns with the quill."""

_SIX = (*SHOULDER_ELBOW_WRIST[:2], *SHOULDER_ELBOW_WRIST[3:])
SIX_JOINTS = tuple(joint[0] for joint in _SIX)
SIX = serial_urdf("six", _SIX)
"""Three axes of which two are parallel, and a spherical wrist."""


def couple_options(sources: Sources) -> list[str]:
    """As the command line has them."""
    out: list[str] = []
    for joint, (terms, c) in sources.items():
        right = "+".join(f"{name}*{k!r}" for name, k in terms.items())
        out += ["--couple", f"{joint}={right}" + (f"{c:+}" if c else "")]
    return out


def joint_values(names: Sequence[str], sources: Sources, motors: Array) -> Array:
    """Values (..., dof) of the joints at those of the motors, term by term."""
    column = dict(zip(names, np.moveaxis(motors, -1, 0), strict=True))
    values = []
    for name in names:
        terms, c = sources.get(name, ({name: 1.0}, 0.0))
        values.append(sum(k * column[source] for source, k in terms.items()) + c)
    return np.stack(values, axis=-1)
