"""The arms to compare solvers on, and ikgen's freshly made code for them."""

from __future__ import annotations

import importlib
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.peer_solvers import AbsentError, Arm
from ikgen.generation.generate import generate
from ikgen.records.request import Outputs, Request

__all__ = ["ARMS", "compiled", "make_arm"]

OPW_IRB2400 = {
    "a1": 0.1, "a2": -0.135, "b": 0.0, "c1": 0.615, "c2": 0.705, "c3": 0.755, "c4": 0.085,
    "offsets": (0.0, 0.0, -np.pi / 2, 0.0, 0.0, 0.0),
}  # fmt: skip
OPW_KR6 = {
    "a1": 0.025, "a2": -0.035, "b": 0.0, "c1": 0.4, "c2": 0.455, "c3": 0.42, "c4": 0.08,
    "offsets": (0.0, -np.pi / 2, 0.0, 0.0, 0.0, 0.0),
    "flip_axes": (True, False, False, True, False, True),
}  # fmt: skip
ARMS: dict[str, tuple[str, tuple[tuple[str, float], ...], dict[str, Any], str]] = {
    "IRB 2400": ("abb_irb2400", (), OPW_IRB2400, "abb_irb_2400_10.yaml"),
    "KR 6 R900": ("kuka_kr6r900sixx", (), OPW_KR6, "kuka_kr_6_r900_sixx.yaml"),
    "UR5e": ("ur5e", (), {}, "ur5e.yaml"),
    "Panda": ("franka_panda_erd", (("panda_joint7", 0.4),), {}, ""),
    "WAM": ("wam", (("/j3", 0.4),), {}, ""),
    "M1013": ("doosan_m1013", (), {}, ""),
    "CRX-10iA": ("fanuc_crx10ia", (), {}, ""),
}
"""Name -> file, held joints with their values, OPW's parameters, ikdh's table."""


def make_arm(name: str, robots: Path, out: Path) -> tuple[Arm, Path]:
    """The arm's modules, freshly generated; the path of its header. Raises AbsentError without its file."""
    file, free, opw, table = ARMS[name]
    if not (robots / f"{file}.urdf").is_file():
        raise AbsentError(f"no {file}.urdf in {robots}")
    request = Request(robots / f"{file}.urdf", free=dict(free), name=file)
    generate(request, Outputs(emit=("python", "cpp", "nanobind"), out=out, verify=False))
    sys.path.insert(0, str(out))
    module = importlib.import_module(f"{file}_ik")
    values = tuple(value for _, value in free)
    return Arm(name, request.robot, module, values, opw, table), out / f"{file}_ik.hpp"


def compiled(name: str, out: Path) -> Any:
    """The compiled package of a name, installed from `out`; raises AbsentError where it cannot be built."""
    target = out / "site"
    command = [sys.executable, "-m", "pip", "install", "-q", "--no-deps", "--target", str(target)]
    done = subprocess.run([*command, str(out / name)], capture_output=True, check=False)
    if done.returncode:
        raise AbsentError("its build tools are not at hand")
    sys.path.insert(0, str(target))
    return importlib.import_module(name)
