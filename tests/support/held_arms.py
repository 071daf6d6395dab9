"""Emitted solvers of arms with one held joint, and of one that holds none."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import ModuleType

import numpy as np
from numpy.typing import NDArray
from tests.support.redundant_arms import (
    LIFT_SCARA,
    OFFSET_ELBOW,
    SHOULDER_ELBOW_WRIST,
    TORSO,
    serial_urdf,
)
from tests.support.solving import FIXTURES, import_text, solver_module

from ikgen.derivation.derive import derive
from ikgen.derivation.read import read
from ikgen.emit.python.python_emitter import emit_module
from ikgen.emit.solver_module import SolverModule
from ikgen.records.request import Request

__all__ = ["HELD", "held_limits", "held_module", "held_of", "imported", "lift_scara", "on_limits"]

HELD: dict[str, tuple[str, ...]] = {
    "shoulder_elbow_wrist": ("wrist_roll",),
    "franka_fr3": ("fr3_joint7",),
    "torso": ("torso", "wrist_roll"),
    "held_forearm": ("wrist_yaw",),
    "arm_angle": ("arm-angle",),
    "offset_elbow": ("arm-angle",),
    "rounded_arm_angle": ("arm-angle",),
    "ur5e": (),
}
"""What each arm holds."""

_JOINTS = {
    "torso": (TORSO, *SHOULDER_ELBOW_WRIST),
    "offset_elbow": OFFSET_ELBOW,
}


def held_of(arm: ModuleType, q: NDArray[np.float64]) -> NDArray[np.float64]:
    """What joint values (..., DOF) have of the first thing that is held."""
    if arm.FREE_JOINTS[0] == "arm_angle":
        return np.asarray(arm.arm_angle(q))
    return np.asarray(q[..., arm.JOINT_NAMES.index(arm.FREE_JOINTS[0])])


def on_limits(arm: ModuleType) -> list[NDArray[np.float64]]:
    """Joint values at which the arm is stretched, or joints stay on their limits over a range of what is
    held: at an arm angle the elbow alone does."""
    count = np.arange(arm.DOF)
    angle = "arm_angle" in arm.FREE_JOINTS
    upper = np.where(count == 3, arm.UPPER, 0.1) if angle else arm.UPPER
    rows = (np.zeros(arm.DOF), upper, np.where(count % 2, arm.LOWER, 0.0))
    return [np.clip(q, arm.LOWER, arm.UPPER) for q in rows]


def held_limits(arm: ModuleType) -> tuple[float, float]:
    """Of the first thing that is held."""
    if arm.FREE_JOINTS[0] == "arm_angle":
        return -np.pi, np.pi
    j = arm.JOINT_NAMES.index(arm.FREE_JOINTS[0])
    return float(arm.LOWER[j]), float(arm.UPPER[j])


def held_module(name: str, folder: Path) -> SolverModule:
    """The solver module of an arm by its name."""
    path = FIXTURES / f"{name}.urdf"
    if not path.is_file():
        path = folder / f"{name}.urdf"
        text = serial_urdf(name, _JOINTS.get(name, SHOULDER_ELBOW_WRIST))
        if name.startswith("rounded"):
            text = text.replace(
                'xyz="0 0 0.35" rpy="0 0 0"', 'xyz="0.00002 0 0.35" rpy="0 0.0005 0.0003"'
            )
        path.write_text(text)
    ends = {"base": "fr3_link0", "tip": "fr3_hand_tcp"} if name == "franka_fr3" else {}
    request = Request(path, **ends, free=dict.fromkeys(HELD[name]))
    return replace(solver_module(read(request).dh), name=name)


def lift_scara(folder: Path) -> SolverModule:
    """The solver module of a SCARA arm on a lift."""
    path = folder / "lift_scara.urdf"
    path.write_text(serial_urdf("lift_scara", LIFT_SCARA))
    return replace(derive(Request(path)).module, name="lift_scara")


def imported(name: str, folder: Path) -> ModuleType:
    """The emitted Python module of an arm by its name."""
    return import_text(emit_module(held_module(name, folder)), folder)
