"""What tells the solutions of one pose apart: shoulder, elbow and wrist where the arm has them, else the
branch that each unknown took."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ikgen.equations.knowledge import Variable
from ikgen.kinematics.classify import GeometryClass
from ikgen.kinematics.forward import row_values
from ikgen.model.dh import DHChain
from ikgen.report.skeleton_bones import skeleton
from ikgen.solver.solution_graph import SolutionGraph

__all__ = ["row_names"]

Array = NDArray[np.float64]

_SAME = 1e-5
"""Difference (rad, m) below which two values of an unknown are one branch."""


def row_names(
    dh: DHChain, geometry: GeometryClass, graph: SolutionGraph, rows: Array
) -> tuple[str, ...]:
    """A name for each of the rows (k, dof), rad and m, no two of them the same."""
    if _has_postures(geometry):
        names = tuple(", ".join(_posture(dh, q)) for q in rows)
        if len(set(names)) == len(rows):
            return names
    names = tuple(", ".join(parts) for parts in _branches(dh, graph, rows))
    if len(set(names)) == len(rows) and all(names):
        return names
    return tuple(f"solution {i}" for i in range(1, len(rows) + 1))


def _has_postures(geometry: GeometryClass) -> bool:
    """Six turning joints, a base whose second axis is square to the first and parallel to the third, and
    a wrist whose axes meet or an arm of three parallel axes before two that cross."""
    wrist = 4 in geometry.spherical_triples or 2 in geometry.parallel_triples
    base = 1 in geometry.perpendicular_pairs and 2 in geometry.parallel_pairs
    return geometry.kinds == "RRRRRR" and base and wrist


def _posture(dh: DHChain, q: Array) -> tuple[str, str, str]:
    """Right and left, up and down, flipped or not, as Lee and Ziegler (1984) tell the arm's
    configurations: by the side of axis 1 on which the wrist is, the side of the line from shoulder to
    wrist on which the elbow is, and the sense in which the wrist turns."""
    frames = skeleton(dh, q).frames
    origin, z = frames[:, :3, 3], frames[:, :3, 2]
    up = -z[1] if z[1, 2] < 0.0 else z[1]
    forward = np.cross(up, z[2])  # of an arm whose second axis points to the right
    side = float((origin[5] - origin[2]) @ forward + (origin[2] - origin[1]) @ forward)
    across = z[2]
    elbow, wrist = (_flat(origin[k] - origin[2], across) for k in (3, 4))
    line = wrist / max(float(np.linalg.norm(wrist)), 1e-12)
    upward = up - (up @ line) * line
    turn = float(np.cross(z[4], z[6]) @ z[5])
    return (
        "shoulder right" if side > 0 else "shoulder left",
        "elbow up" if float(upward @ elbow) > 0 else "elbow down",
        "wrist not flipped" if turn > 0 else "wrist flipped",
    )


def _flat(v: Array, across: Array) -> Array:
    return np.asarray(v - (v @ across) * across)


def _branches(dh: DHChain, graph: SolutionGraph, rows: Array) -> list[tuple[str, ...]]:
    """Per row the branch of each unknown with several, numbered by its values among the rows that agree
    in the unknowns before it."""
    values = row_values(dh, rows)
    names: list[tuple[str, ...]] = [() for _ in rows]
    for step in graph.steps:
        if step.branches < 2:
            continue
        own = _unknown(step.candidate.unknown, values)
        names = [
            (*name, f"{_words(step.candidate.unknown)} branch {_rank(i, own, names)}")
            for i, name in enumerate(names)
        ]
    return names


def _unknown(v: Variable, values: Array) -> Array:
    total = values @ np.array(v.combination, dtype=float)
    if v.kind != "angle":
        return np.asarray(total)
    turned = np.remainder(total + np.pi - _SAME / 2, 2 * np.pi) - np.pi
    return np.asarray(turned)


def _rank(i: int, own: Array, names: Sequence[tuple[str, ...]]) -> int:
    """The place, from 1, of a row's value among those of the rows with the same name so far."""
    beside = sorted(own[k] for k, name in enumerate(names) if name == names[i])
    distinct = [v for n, v in enumerate(beside) if n == 0 or v - beside[n - 1] > _SAME]
    return 1 + sum(bool(own[i] - v > _SAME) for v in distinct)


def _words(v: Variable) -> str:
    return v.text.replace("theta_", "θ").replace("d_", "d")
