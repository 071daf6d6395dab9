"""Values of expressions at configurations other than the probes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ikgen.algebra.expression import BINARY, UNARY, Expr
from ikgen.equations.equation_set import EquationSet
from ikgen.equations.probes import dh_pose, elbow_position
from ikgen.kinematics.fixed_order import cosines, product, sines
from ikgen.model.entry_names import entry_place

__all__ = ["evaluate"]


def evaluate(
    system: EquationSet, roots: Sequence[Expr], values: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Values (len(roots), N) of expressions at DH variables `values` (N, dof)."""
    pose = dh_pose(system.dh, values)
    if system.tool_on_right:
        pose = product(pose, system.dh.X_tip)
    known: dict[int, NDArray[np.float64]] = {}

    def atom(node: Expr) -> NDArray[np.float64]:
        assert node.atom is not None
        kind, key = node.atom.kind, node.atom.key
        if kind == "pose":
            assert isinstance(key, str)
            if key[0] == "e":
                return elbow_position(system.dh, values)[:, "xyz".index(key[1])]
            row, column = entry_place(key)
            return np.asarray(pose[:, row, column])
        angle = product(values, np.array(key, dtype=float))
        return np.asarray({"cos": cosines, "sin": sines}.get(kind, np.asarray)(angle))

    def visit(node: Expr) -> NDArray[np.float64]:
        found = known.get(node.id)
        if found is None:
            if node.atom is not None:
                found = atom(node)
            elif not node.args:
                found = np.full(len(values), _meant(node))
            else:
                args = [visit(a) for a in node.args]
                if node.op == "select":
                    found = np.where(args[0] > 0.5, args[1], args[2])
                else:
                    found = np.asarray((BINARY.get(node.op) or UNARY[node.op])(*args))
            known[node.id] = found
        return found

    with np.errstate(all="ignore"):
        return np.stack([visit(r) for r in roots])


def _meant(node: Expr) -> float:
    """A constant's value, of a rounded one that which was meant: the value at the last probe."""
    return float(node.probe[-1]) if node.op == "param" else node.value
