"""An arm of six axes whose closed form gives rows that are told, whatever the pose."""

from __future__ import annotations

from collections.abc import Callable
from math import pi
from typing import Any

import numpy as np
from numpy.typing import NDArray
from tests.support.chains import rotation, translation

from ikgen.elimination.routine import runtime_policy
from ikgen.program.policy import SolvePolicy
from ikgen.runtime.python.arm.chain_kinematics import chain_of
from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arm.whole_pose import PoseTask

Array = NDArray[np.float64]
FRAMES = np.array(
    [
        rotation([1.0, 0.3 * k, 0.1], 0.4 + 0.5 * k) @ translation(0.3, -0.2, 0.1 * k)
        for k in range(7)
    ]
)
NONE: Array = np.zeros((1, 0))
"""Values of no held joints, of one pose."""


def given_rows(
    rows: Array, valid: str = "", singular: str = "", rough: str = "", doubt: str = ""
) -> Callable[[Array, Array, Array], Any]:
    """A closed form that gives these (m, 6) for any pose; "x" in a text for rows of which it says so, and
    all are valid where nothing else is told."""
    texts = valid or "x" * len(rows), singular, rough, doubt
    flags = [np.array([c == "x" for c in text.ljust(len(rows), ".")]) for text in texts]

    def branches(T: Array, near: Array, held: Array) -> Any:
        return (
            np.tile(rows, (len(T), 1, 1)),
            *(np.tile(flag, (len(T), 1)) for flag in flags),
        )

    return branches


def in_doubt(*_: Any) -> Any:
    """A closed form on floats that leaves every pose to that in arrays."""
    return [], True


def given_arm(branches: Any, **more: Any) -> Arm:
    """With that closed form, and no limits but a turn to either side."""
    chain = chain_of(FRAMES, tuple((j, True, 1.0, 0.0) for j in range(6)), 6)
    fields: dict[str, Any] = {
        "chain": chain, "task": PoseTask(1.0), "policy": runtime_policy(SolvePolicy()),
        "lower": (-2.0 * pi,) * 6, "upper": (2.0 * pi,) * 6, "free": (), "free_joints": (),
        "free_defaults": (), "most": 8, "branches": in_doubt, "branches_batch": branches,
        "beside": np.zeros((0, 4, 4)), "period": (2.0 * pi,) * 6, "moving": tuple(range(6)),
        "together": None, "branch_kind": "number", "elbow_end": 5, "around": None,
    }  # fmt: skip
    return Arm(**{**fields, **more})
