"""Other packages' solvers behind one signature: pose (4, 4) of the arm's tip in its base -> rows (k, dof).

Each factory takes an `Arm` and raises `AbsentError` with the reason where a package cannot be compared.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["PEERS", "AbsentError", "Arm", "Solver"]

Array = NDArray[np.float64]
Solver = Callable[[Array], Array]


class AbsentError(Exception):
    """A package is not installed, or does not cover the arm."""


@dataclass(frozen=True)
class Arm:
    """One arm: its URDF, ikgen's Python module, and what peers need beyond the URDF."""

    name: str
    urdf: Path
    module: ModuleType
    free: tuple[float, ...] = ()
    opw: dict[str, Any] = field(default_factory=dict)
    ikdh: str = ""

    @property
    def held(self) -> list[tuple[int, float]]:
        """Index and value of every held joint."""
        return [
            (self.module.JOINT_NAMES.index(n), v)
            for n, v in zip(self.module.FREE_JOINTS, self.free, strict=True)
        ]


def _import(name: str) -> Any:
    import importlib

    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise AbsentError("not installed") from error


def _calibrated(arm: Arm, forward: Callable[[Array], Array]) -> tuple[Array, Array]:
    """Constant transforms B, X with `arm's forward = B @ forward @ X`; B is a turn about z by a
    right angle. Raises AbsentError where the peer's geometry is another one."""
    rng = np.random.default_rng(5)
    q = rng.uniform(-1.0, 1.0, (4, arm.module.DOF))
    mine = arm.module.forward(q)
    its = np.array([forward(row) for row in q])
    for quarter in range(4):
        B = np.eye(4)
        c, s = round(np.cos(quarter * np.pi / 2)), round(np.sin(quarter * np.pi / 2))
        B[:2, :2] = [[c, -s], [s, c]]
        X = np.linalg.inv(B @ its[0]) @ mine[0]
        if np.abs(B @ its @ X - mine).max() < 1e-6:
            return B, X
    raise AbsentError("its geometry of the arm differs")


def eaik(arm: Arm) -> Solver:
    """EAIK (subproblem decomposition, C++), from axes and points at zero."""
    core = _import("eaik.pybindings.EAIK")
    zero = np.zeros(arm.module.DOF)
    tip, J = arm.module.forward(zero), arm.module.jacobian(zero)
    axes = J[3:].T
    points = tip[:3, 3] - np.cross(J[:3].T, axes)
    steps = np.diff(np.vstack([np.zeros(3), points, tip[:3, 3]]), axis=0)
    robot = core.Robot(axes.T, steps.T, tip[:3, :3], arm.held, True)
    if not robot.has_known_decomposition():
        raise AbsentError("knows no decomposition of the arm")

    def solve(pose: Array) -> Array:
        found = robot.calculate_IK(pose)
        rows = np.asarray(found.Q, dtype=float).reshape(-1, arm.module.DOF)
        exact = ~np.asarray(found.is_LS, dtype=bool)
        return rows[exact] if len(rows) else rows

    return solve


def opw(arm: Arm) -> Solver:
    """py-opw-kinematics (ortho-parallel base and spherical wrist, Rust)."""
    package = _import("py_opw_kinematics")
    if not arm.opw:
        raise AbsentError("not an OPW arm, or no parameters at hand")
    robot = package.Robot(package.KinematicModel(**arm.opw), degrees=False)
    _, X = _calibrated(arm, lambda q: np.asarray(robot.forward(tuple(q)).as_matrix()))
    back = np.linalg.inv(X)
    core = robot._robot

    def solve(pose: Array) -> Array:
        return np.array(core.inverse(pose @ back, None, None)).reshape(-1, 6)

    return solve


def ssik(arm: Arm) -> Solver:
    """ssik (subproblems, Python with a native core), from the URDF."""
    package = _import("ssik")
    try:
        robot = package.Manipulator.from_urdf(
            arm.urdf, base=arm.module.BASE_LINK, ee=arm.module.TIP_LINK
        )
    except Exception as error:
        raise AbsentError(f"does not load the URDF: {str(error)[:60]}") from error

    def solve(pose: Array) -> Array:
        return np.array([s.q for s in robot.solve(pose)]).reshape(-1, arm.module.DOF)

    return solve


def ikdh(arm: Arm) -> Solver:
    """ikdh (C++), from its own table of the arm."""
    package = _import("ikdh")
    if not arm.ikdh:
        raise AbsentError("has no table of the arm")
    robot = package.load_robot(arm.ikdh)
    B, X = _calibrated(arm, lambda q: np.asarray(package.forward_kin(robot.dh, np.degrees(q))))
    solver = package.Solver(robot.dh, robot.limits)
    front, back = np.linalg.inv(B), np.linalg.inv(X)

    def solve(pose: Array) -> Array:
        return np.radians(np.array(solver.solve(front @ pose @ back)).reshape(-1, 6))

    return solve


def clik(arm: Arm) -> Solver:
    """Pinocchio's forward kinematics and Jacobians in a damped Newton loop: one row, 20 starts."""
    pin = _import("pinocchio")
    model = _reduced_model(pin, arm)
    data = model.createData()
    tip, base = model.getFrameId(arm.module.TIP_LINK), model.getFrameId(arm.module.BASE_LINK)
    pin.framesForwardKinematics(model, data, pin.neutral(model))
    root = data.oMf[base].copy()
    names = [n for n in arm.module.JOINT_NAMES if n not in arm.module.FREE_JOINTS]
    order = [model.joints[model.getJointId(n)].idx_q for n in names]
    places = [arm.module.JOINT_NAMES.index(n) for n in names]
    rng = np.random.default_rng(1)

    def solve(pose: Array) -> Array:
        target = root * pin.SE3(pose[:3, :3], pose[:3, 3])
        for _ in range(20):
            start = rng.uniform(-2.0, 2.0, model.nq)
            q = _descend(pin, model, data, tip, start, target)
            if q is not None:
                row = np.empty(arm.module.DOF)
                row[places] = q[order]
                for i, value in arm.held:
                    row[i] = value
                return row[None]
        return np.empty((0, arm.module.DOF))

    return solve


def _reduced_model(pin: Any, arm: Arm) -> Any:
    """Pinocchio's model of the arm's moving joints."""
    model = pin.buildModelFromUrdf(str(arm.urdf))
    keep = [model.getJointId(n) for n in arm.module.JOINT_NAMES]
    held = {model.getJointId(n): v for n, v in zip(arm.module.FREE_JOINTS, arm.free, strict=True)}
    start = pin.neutral(model)
    for joint, value in held.items():
        start[model.joints[joint].idx_q] = value
    lock = [j for j in range(1, model.njoints) if j not in keep or j in held]
    return pin.buildReducedModel(model, lock, start)


def _descend(pin: Any, model: Any, data: Any, tip: int, q: Array, target: Any) -> Array | None:
    """Damped Newton steps from q (nq,) until frame `tip` is at `target`; None if they fail."""
    for _ in range(60):
        pin.framesForwardKinematics(model, data, q)
        error = pin.log6(data.oMf[tip].actInv(target)).vector
        if np.linalg.norm(error) < 1e-9:
            return q
        J = pin.computeFrameJacobian(model, data, q, tip)
        damping = 1e-3 * min(1.0, float(error @ error)) + 1e-12
        q = q + J.T @ np.linalg.solve(J @ J.T + damping * np.eye(6), error)
    return None


PEERS: dict[str, Callable[[Arm], Solver]] = {
    "EAIK (compiled)": eaik,
    "py-opw-kinematics (compiled)": opw,
    "ikdh": ikdh,
    "ssik": ssik,
    "Pinocchio CLIK (one row)": clik,
}
