"""Rows of joint values from a derivation's SymPy expressions, evaluated by NumPy."""

from __future__ import annotations

import numpy as np
import sympy
from numpy.typing import NDArray

from ikgen.emit.derivation import Derivation
from ikgen.kinematics.rigid import inverse
from ikgen.model.dh import DHChain
from ikgen.symbolic import solutions
from ikgen.symbolic.joint_solutions import Branch
from ikgen.symbolic.symbol_names import SymbolNames

__all__ = ["symbolic_rows"]

Array = NDArray[np.float64]


def symbolic_rows(derivation: Derivation, poses: Array) -> Array:
    """Joint values (N, M, dof) of tip poses (N, 4, 4) by every choice of branches; NaN where one of them is
    not real. Whether they give the pose back is for the caller to see."""
    names = SymbolNames(derivation.graph.dh)
    given = _given(derivation, names, poses)
    solved: dict[sympy.Symbol, Array] = {}
    width = 1
    for branches in solutions(derivation).values():
        columns = [_values(branch, {**given, **solved}, (len(poses), width)) for branch in branches]
        solved = {symbol: np.tile(x, (1, len(branches))) for symbol, x in solved.items()}
        solved[branches[0].variable] = np.concatenate(columns, axis=1)
        width *= len(branches)
    dh = derivation.graph.dh
    return np.stack([_joint(dh, j, solved[names.joint(j)]) for j in range(dh.dof)], axis=-1)


def _given(
    derivation: Derivation, names: SymbolNames, poses: Array
) -> dict[sympy.Symbol, Array | float]:
    """Values of the arm's constants, and (N, 1) of the pose's entries in DH frames."""
    dh = derivation.graph.dh
    constants = [x for row in dh.rows for x in (row.alpha, row.a, row.d) if x.name is not None]
    given: dict[sympy.Symbol, Array | float] = {
        names.constant(str(x.name)): x.value * getattr(x, "sign", 1) for x in constants
    }
    T = inverse(dh.X_base) @ poses
    if derivation.task.whole_pose:
        T = T @ inverse(dh.X_tip)
    for i in range(3):
        given[names.pose(f"p{'xyz'[i]}")] = T[:, i, 3:]
        for j in range(3):
            given[names.pose(f"r{i + 1}{j + 1}")] = T[:, i, j : j + 1]
    return given


def _values(
    branch: Branch, known: dict[sympy.Symbol, Array | float], shape: tuple[int, int]
) -> Array:
    """The branch's values (N, M)."""
    used = sorted(branch.expression.free_symbols, key=str)
    function = sympy.lambdify(used, branch.expression, "numpy", cse=True)
    with np.errstate(all="ignore"):
        return np.array(np.broadcast_to(function(*(known[s] for s in used)), shape))


def _joint(dh: DHChain, joint: int, variable: Array) -> Array:
    """The joint's value: angles in (-pi, pi]."""
    row = dh.lead_row(joint)
    value = (variable - row.offset.value) / row.scale
    return np.arctan2(np.sin(value), np.cos(value)) if row.revolute else value
