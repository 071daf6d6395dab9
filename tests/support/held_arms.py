"""Emitted solvers of arms with one held joint, and of one that holds none."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import ModuleType

from tests.support.redundant_arms import SHOULDER_ELBOW_WRIST, TORSO, serial_urdf
from tests.support.solving import FIXTURES, import_text, solver_module

from ikgen.emit.python.python_emitter import emit_module
from ikgen.emit.solver_module import SolverModule
from ikgen.generation.read import read
from ikgen.generation.request import Request

__all__ = ["HELD", "held_module", "imported"]

HELD: dict[str, tuple[str, ...]] = {
    "shoulder_elbow_wrist": ("wrist_roll",),
    "franka_fr3": ("fr3_joint7",),
    "torso": ("torso", "wrist_roll"),
    "ur5e": (),
}
"""The joints that each arm holds."""


def held_module(name: str, folder: Path) -> SolverModule:
    """The solver module of an arm by its name."""
    path = FIXTURES / f"{name}.urdf"
    if not path.is_file():
        joints = (
            SHOULDER_ELBOW_WRIST
            if name == "shoulder_elbow_wrist"
            else (TORSO, *SHOULDER_ELBOW_WRIST)
        )
        path = folder / f"{name}.urdf"
        path.write_text(serial_urdf(name, joints))
    ends = {"base": "fr3_link0", "tip": "fr3_hand_tcp"} if name == "franka_fr3" else {}
    request = Request(path, **ends, free=dict.fromkeys(HELD[name]))
    return replace(solver_module(read(request).dh), name=name)


def imported(name: str, folder: Path) -> ModuleType:
    """The emitted Python module of an arm by its name."""
    return import_text(emit_module(held_module(name, folder)), folder)
