"""Hand-made arms that obey the contract, and their wrong siblings, to test `ikgen.verify` with."""

from __future__ import annotations

from pathlib import Path

from ikgen.model.joint_tree import JointTree, Source
from ikgen.verify.oracle import PinocchioOracle
from ikgen.verify.runners.python_module import PythonModule

JOINTS = ("j1", "j2", "j3", "j4", "j5", "j6")

_JOINT = """
<joint name="j{i}" type="{type}"><parent link="l{before}"/><child link="l{i}"/>
<origin xyz="0 0 {z}"/><axis xyz="{axis}"/>{limit}</joint><link name="l{i}"/>"""
_ROWS = (
    (1, "revolute", 0.4, "0 0 1", -2.9, 2.9),
    (2, "revolute", 0.0, "0 1 0", -2.0, 2.0),
    (3, "revolute", 0.5, "0 1 0", -2.5, 2.5),
    (4, "continuous", 0.4, "0 0 1", None, None),
    (5, "revolute", 0.0, "0 1 0", -2.2, 2.2),
    (6, "revolute", 0.0, "0 0 1", -6.28, 6.28),
)


def six_axis_urdf(effort: float = 10) -> str:
    """A spherical-wrist arm: Rz | Ry | 0.5 | Ry | 0.4 | Rz Ry Rz | 0.1, standing on 0.4 m."""
    parts = ['<robot name="fake"><link name="l0"/>']
    for i, kind, z, axis, lower, upper in _ROWS:
        limit = "" if lower is None else (
            f'<limit lower="{lower}" upper="{upper}" effort="{effort}" velocity="1"/>'
        )  # fmt: skip
        parts.append(_JOINT.format(i=i, before=i - 1, type=kind, z=z, axis=axis, limit=limit))
    parts.append(
        '<joint name="flange" type="fixed"><parent link="l6"/><child link="tip"/>'
        '<origin xyz="0 0 0.1"/></joint><link name="tip"/></robot>'
    )
    return "".join(parts)


def tree_of(text: str) -> JointTree:
    """A tree with nothing but the text: all that an oracle may read."""
    return JointTree("fake", (), (), "", Source(Path("fake.urdf"), "urdf", text, ""))


def six_axis_oracle() -> PinocchioOracle:
    """The oracle of the six-axis arm."""
    return PinocchioOracle(tree_of(six_axis_urdf()), "l0", "tip", JOINTS)


MODULE = """
from __future__ import annotations
import math
from dataclasses import dataclass
from enum import Enum
import numpy as np

JOINT_NAMES = ("j1", "j2", "j3", "j4", "j5", "j6")
LOWER = np.array([-2.9, -2.0, -2.5, -math.inf, -2.2, -6.28])
UPPER = -LOWER
BASE_LINK, TIP_LINK, DOF, MAX_SOLUTIONS, TASK = "l0", "tip", 6, 8, "pose"
FREE_JOINTS = ()
SOURCE_SHA256, GENERATOR_VERSION = "", "0"
H, A, B, D = 0.4, 0.5, 0.4, 0.1

class Status(Enum):
    OK = 0
    UNREACHABLE = 1
    LIMITS = 2
    INVALID = 3

@dataclass(frozen=True)
class Solutions:
    q: object
    status: Status
    singular: object

def _rz(t):
    c, s = np.cos(t), np.sin(t); o, i = 0 * t, 0 * t + 1
    return np.moveaxis(np.array([[c, -s, o], [s, c, o], [o, o, i]]), (0, 1), (-2, -1))

def _ry(t):
    c, s = np.cos(t), np.sin(t); o, i = 0 * t, 0 * t + 1
    return np.moveaxis(np.array([[c, o, s], [o, i, o], [-s, o, c]]), (0, 1), (-2, -1))

def _frames(q):
    q = np.asarray(q, dtype=float)
    if q.shape[-1] != 6:
        raise ValueError("q must have 6 values")
    up, R, p = np.array([0, 0, 1.0]), np.broadcast_to(np.eye(3), (*q.shape[:-1], 3, 3)), 0.0
    frames = []
    for k, (turn, length) in enumerate(
        zip((_rz, _ry, _ry, _rz, _ry, _rz), (H, 0, A, B, 0, 0))
    ):
        p = p + R @ (length * up)
        frames.append((R[..., :, 1] if turn is _ry else R[..., :, 2], p))
        R = R @ turn(q[..., k])
    return frames, R, p + R @ (D * up)

def forward(q):
    _, R, p = _frames(q)
    T = np.zeros((*p.shape[:-1], 4, 4))
    T[..., :3, :3], T[..., :3, 3], T[..., 3, 3] = R, p, 1
    return T

def jacobian(q):
    frames, _, p = _frames(q)
    return np.array([[*np.cross(z, p - o), *z] for z, o in frames]).T

def _wrap(x):
    x = math.remainder(x, 2 * math.pi)
    return math.pi if x == -math.pi else x

def _branches(T, seed):
    R, p = T[:3, :3], T[:3, 3]
    x, y, z = p - D * R[:, 2]
    radius = math.hypot(x, y)
    for side in (1, -1) if radius > 1e-9 else (0,):
        r = side * radius
        q1 = math.atan2(side * y, side * x) if side else (0.0 if seed is None else seed[0])
        c3 = (r * r + (z - H) ** 2 - A * A - B * B) / (2 * A * B)
        if abs(c3) > 1 + 1e-9:  # REACH
            continue
        c3 = min(1.0, max(-1.0, c3))
        for elbow in (1, -1):
            q3 = elbow * math.acos(c3)
            q2 = math.atan2(r, z - H) - math.atan2(B * math.sin(q3), A + B * math.cos(q3))
            W = (_rz(np.float64(q1)) @ _ry(np.float64(q2 + q3))).T @ R
            s5 = math.hypot(W[0, 2], W[1, 2])
            for flip in (1, -1):
                q5 = math.atan2(flip * s5, W[2, 2])
                flat = s5 < 1e-10
                q4 = math.atan2(flip * W[1, 2], flip * W[0, 2])
                if flat:
                    q4 = 0.0 if seed is None else seed[3]
                V = (_rz(np.float64(q4)) @ _ry(np.float64(q5))).T @ W
                q6 = math.atan2(V[1, 0], V[0, 0])
                yield [_wrap(v) for v in (q1, q2, q3, q4, q5, q6)], flat or not side

def _inside(q):
    return all(lo - 1e-7 <= v <= hi + 1e-7 for v, lo, hi in zip(q, LOWER, UPPER))

def _answer(rows, flags, status, seed):
    rows, flags = np.array(rows).reshape(-1, 6), np.array(flags, dtype=bool)
    if seed is not None and len(rows):
        order = np.argsort(np.linalg.norm(rows - seed, axis=1))
        rows, flags = rows[order], flags[order]
    return Solutions(rows, status, flags)

def solve(pose, *, free=None, seed=None, limits=True):
    T = np.asarray(pose, dtype=float)
    if T.shape != (4, 4) or (seed is not None and np.shape(seed) != (6,)):
        raise ValueError("bad shape")
    R = T[:3, :3]
    if not (np.isfinite(T).all() and np.allclose(R.T @ R, np.eye(3)) and np.linalg.det(R) > 0):
        return _answer([], [], Status.INVALID, seed)
    rows, flags = [], []
    for q, flag in _branches(T, seed):
        if not np.max(np.abs(forward(q) - T)) < 1e-8:  # TEST
            continue
        if all(max(abs(_wrap(a - b)) for a, b in zip(q, row)) > 1e-6 for row in rows):
            rows.append(q)
            flags.append(flag)
    if not rows:
        return _answer([], [], Status.UNREACHABLE, seed)
    kept = [k for k, q in enumerate(rows) if not limits or _inside(q)]
    if not kept:
        return _answer([], [], Status.LIMITS, seed)
    return _answer([rows[k] for k in kept], [flags[k] for k in kept], Status.OK, seed)

def solve_batch(poses, *, free=None, seed=None, limits=True):
    q = np.full((len(poses), MAX_SOLUTIONS, 6), np.nan)
    found = [solve(T, seed=seed, limits=limits) for T in poses]
    for row, s in zip(q, found):
        row[: len(s.q)] = s.q
    return q, np.array([len(s.q) for s in found]), np.array([s.status for s in found], dtype=object)
"""

_ANSWER = "    rows, flags = np.array(rows).reshape(-1, 6), np.array(flags, dtype=bool)\n"
_KEEP_WRONG = (
    "        if not np.max(np.abs(forward(q) - T)) < 1e-8:  # TEST\n            continue\n",
    "",
)

# name of the defect: (the check that must catch it, (old text, new text), ...)
DEFECTS: dict[str, tuple[str, tuple[tuple[str, str], ...]]] = {
    "row off by 1e-6": (
        "closure",
        ((_ANSWER, _ANSWER + "    if len(rows) > 3: rows[3, 4] += 1e-6\n"),),
    ),
    "missing branch": (
        "exhaustive search",
        (("for elbow in (1, -1)", "for elbow in (1,)"),),
    ),
    "branch lost with its flip": (
        "completeness",
        (("for flip in (1, -1)", "for flip in (1,)"),),
    ),
    "duplicate row": (
        "distinct rows",
        ((_ANSWER, "    rows, flags = rows + rows[:1], flags + flags[:1]\n" + _ANSWER),),
    ),
    "duplicate row a turn away": (
        "distinct rows",
        (
            (
                _ANSWER,
                "    more = [[*r[:3], r[3] + 2 * math.pi, *r[4:]] for r in rows[:1]]\n"
                "    rows, flags = rows + more, "
                "flags + flags[:1]\n" + _ANSWER,
            ),
        ),
    ),
    "unreachable reported OK": (
        "unreachable poses",
        (("        if abs(c3) > 1 + 1e-9:  # REACH\n            continue\n", ""), _KEEP_WRONG),
    ),
    "unreachable raises": (
        "runs",
        (("            continue\n        c3", "            raise ArithmeticError\n        c3"),),
    ),
    "swapped joints": (
        "closure",
        ((_ANSWER, _ANSWER + "    rows[:, [3, 5]] = rows[:, [5, 3]]\n"),),
    ),
    "swapped names": (
        "constants",
        (('JOINT_NAMES = ("j1", "j2"', 'JOINT_NAMES = ("j2", "j1"'),),
    ),
    "singular pose without answer": (
        "singular poses",
        (
            ("                flat = s5 < 1e-10\n", "                if s5 < 1e-10: continue\n"),
            ("flat", "0"),
        ),
    ),
    "singular row not flagged": (
        "singular flags",
        (("flat or not side", "not side"),),
    ),
    "regular row flagged": (
        "singular flags",
        (("flat or not side", "True"),),
    ),
    "NaN pose accepted": (
        "invalid poses",
        (("np.isfinite(T).all() and", ""), ("Status.INVALID", "Status.OK")),
    ),
    "reflection accepted": (
        "invalid poses",
        ((" and np.linalg.det(R) > 0", ""), _KEEP_WRONG),
    ),
    "bad shape accepted": (
        "bad shapes",
        (("T.shape != (4, 4) or (", "("), ("(seed is not None and", "False and (")),
    ),
    "limits ignored": (
        "inside limits",
        (("if not limits or _inside(q)", "if True"),),
    ),
    "row at a limit dropped": (
        "completeness",
        (("lo - 1e-7 <= v <= hi + 1e-7", "lo + 1e-7 <= v <= hi - 1e-7"),),
    ),
    "row inside limits dropped": (
        "choice by limits",
        (("lo - 1e-7 <= v <= hi + 1e-7", "0.9 * lo <= v <= 0.9 * hi"),),
    ),
    "limits called unreachable": (
        "status",
        (("Status.LIMITS, seed", "Status.UNREACHABLE, seed"),),
    ),
    "seed disregarded": (
        "seed order",
        (("np.argsort(np", "np.argsort(-np"),),
    ),
    "wrong limits": (
        "constants",
        (("[-2.9, -2.0", "[-2.8, -2.0"),),
    ),
    "forward off": (
        "forward",
        (("D = 0.4, 0.5, 0.4, 0.1", "D = 0.4, 0.5, 0.4, 0.1001"),),
    ),
    "jacobian about the base": (
        "jacobian",
        (("np.cross(z, p - o)", "np.cross(z, p)"),),
    ),
    "batch loses the last row": (
        "solve_batch",
        (("np.array([len(s.q) for s in found])", "np.array([len(s.q) // 2 for s in found])"),),
    ),
    "random order": (
        "determinism",
        ((_ANSWER, "    rows = [rows[k] for k in np.random.permutation(len(rows))]\n" + _ANSWER),),
    ),
}  # fmt: skip


def six_axis_module(folder: Path, defect: str = "") -> PythonModule:
    """The six-axis arm's module, written to `folder` and loaded; `defect` is a key of `DEFECTS`."""
    text = MODULE
    for old, new in DEFECTS[defect][1] if defect else ():
        assert old in text, old
        text = text.replace(old, new)
    path = folder / "fake_ik.py"
    path.write_text(text, encoding="utf-8")
    return PythonModule(path)
