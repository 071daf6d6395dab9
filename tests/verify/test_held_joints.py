"""Free joints: a planar arm of three joints for the task position, its last joint held."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.support.fake_arms import tree_of

from ikgen.tasks import find_task
from ikgen.verify.arm import arm_under_test
from ikgen.verify.interface_checks import check_constants
from ikgen.verify.oracle import PinocchioOracle
from ikgen.verify.runners.python_module import PythonModule
from ikgen.verify.task_space import task_space
from ikgen.verify.verification import verify

_LINK = """<joint name="j{i}" type="continuous"><parent link="l{before}"/><child link="l{i}"/>
<origin xyz="{x} 0 0"/><axis xyz="0 0 1"/></joint><link name="l{i}"/>"""
URDF = (
    '<robot name="p"><link name="l0"/>'
    + "".join(_LINK.format(i=i, before=i - 1, x=x) for i, x in ((1, 0), (2, 0.6), (3, 0.3)))
    + '<joint name="end" type="fixed"><parent link="l3"/><child link="tip"/>'
    '<origin xyz="0.2 0 0"/></joint><link name="tip"/></robot>'
)

MODULE = """
import math
from dataclasses import dataclass
from enum import Enum
import numpy as np

JOINT_NAMES, FREE_JOINTS = ("j1", "j2", "j3"), ("j3",)
LOWER, UPPER = np.full(3, -math.inf), np.full(3, math.inf)
BASE_LINK, TIP_LINK, DOF, MAX_SOLUTIONS, TASK = "l0", "tip", 3, 2, "position"
SOURCE_SHA256 = GENERATOR_VERSION = ""
Status = Enum("Status", "OK UNREACHABLE LIMITS INVALID")

@dataclass(frozen=True)
class Solutions:
    q: object
    status: Status
    singular: object

def forward(q):
    a = np.cumsum(np.asarray(q, dtype=float), axis=-1)
    if a.shape[-1] != 3:
        raise ValueError("q must have 3 values")
    T = np.zeros((*a.shape[:-1], 4, 4))
    c, s = np.cos(a), np.sin(a)
    T[..., 0, 0] = T[..., 1, 1] = c[..., 2]
    T[..., 1, 0], T[..., 0, 1] = s[..., 2], -s[..., 2]
    T[..., 2, 2] = T[..., 3, 3] = 1
    T[..., 0, 3], T[..., 1, 3] = c @ [0.6, 0.3, 0.2], s @ [0.6, 0.3, 0.2]
    return T

def jacobian(q):
    a, J = np.cumsum(q), np.zeros((6, 3))
    for k in range(3):
        J[0, k] = -np.dot(np.sin(a), [0.6, 0.3, 0.2]) + np.dot(np.sin(a)[:k], [0.6, 0.3, 0.2][:k])
        J[1, k] = np.dot(np.cos(a), [0.6, 0.3, 0.2]) - np.dot(np.cos(a)[:k], [0.6, 0.3, 0.2][:k])
    J[5] = 1
    return J

def solve(pose, *, free=None, seed=None, limits=True):
    T = np.asarray(pose, dtype=float)
    if T.shape != (4, 4) or (seed is not None and np.shape(seed) != (3,)):
        raise ValueError("bad shape")
    none = np.empty((0, 3))
    if not np.isfinite(T[:3, 3]).all():
        return Solutions(none, Status.INVALID, [])
    q3 = 0.0 if free is None else float(free[0])
    fx, fy = 0.3 + 0.2 * math.cos(q3), 0.2 * math.sin(q3)
    L, phi = math.hypot(fx, fy), math.atan2(fy, fx)
    x, y, z = T[:3, 3]
    c = (x * x + y * y - 0.36 - L * L) / (1.2 * L)
    if abs(c) > 1 + 1e-9 or abs(z) > 1e-9:
        return Solutions(none, Status.UNREACHABLE, [])
    rows = []
    for sign in (1, -1):
        t = sign * math.acos(max(-1.0, min(1.0, c)))
        if sign < 0 and min(-t, math.pi + t) < 1e-6:
            continue
        q1 = math.atan2(y, x) - math.atan2(L * math.sin(t), 0.6 + L * math.cos(t))
        rows.append([math.remainder(v, 2 * math.pi) for v in (q1, t - phi, q3)])
    rows = np.array(rows)
    if seed is not None:
        rows = rows[np.argsort(np.linalg.norm(rows - seed, axis=1))]
    return Solutions(rows, Status.OK, np.zeros(len(rows), dtype=bool))

def solve_batch(poses, *, free=None, seed=None, limits=True):
    q = np.full((len(poses), 2, 3), np.nan)
    held = [None] * len(poses) if free is None else free
    found = [solve(T, free=one) for T, one in zip(poses, held)]
    for row, s in zip(q, found):
        row[: len(s.q)] = s.q
    return q, np.array([len(s.q) for s in found]), np.array([s.status.value for s in found])
"""


@pytest.mark.parametrize(
    "defect", ["", "if free is None else float(free[0])", "if free is None else free\n"]
)
def test_free_joint(tmp_path: Path, defect: str) -> None:
    path = tmp_path / "planar_ik.py"
    end = "\n" if defect.endswith("\n") else ""
    path.write_text(MODULE.replace(defect, f"if True else 1.0{end}") if defect else MODULE)
    oracle = PinocchioOracle(tree_of(URDF), "l0", "tip", ["j1", "j2", "j3"])
    report = verify(PythonModule(path), oracle, samples=100)
    assert report.task == "position"
    assert report.check("free joints").count > 0
    assert report.check("free joints").passed == (not defect)
    assert report.passed == (not defect), report.worst_case


@pytest.mark.parametrize(
    ("told", "right"),
    [("(0.0,)", True), ("(2.0,)", False), ("(float('inf'),)", False), ("()", False)],
)
def test_defaults_lie_inside_the_limits(tmp_path: Path, told: str, right: bool) -> None:
    path = tmp_path / "planar_ik.py"
    path.write_text(f"{MODULE}\n_FREE_DEFAULTS = {told}\n")
    oracle = PinocchioOracle(tree_of(URDF), "l0", "tip", ["j1", "j2", "j3"])
    bound = np.array([np.inf, np.inf, np.inf if "inf" in told else 1.0])
    limits = (-bound, bound)
    arm = arm_under_test(oracle, task_space(find_task("position")), limits, ("j3",))
    runner = PythonModule(path)
    none = runner.solve_many(np.empty((0, 4, 4)))
    detail = check_constants(arm, runner, none).detail
    assert ("defaults of free joints" in detail) == (not right)
