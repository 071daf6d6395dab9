"""What is shown of a target: all solutions of the emitted module, named, with how good they are."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ikgen.emit.derivation import Derivation
from ikgen.kinematics.forward import file_jacobian
from ikgen.model.arrays import Array
from ikgen.report.example_section import joint_text
from ikgen.verify.runners.python_module import PythonModule

__all__ = ["Branch", "Solved", "solved"]


@dataclass(frozen=True, slots=True)
class Branch:
    """One solution `q` (dof,), rad and m: its name, whether it is inside the limits, the smallest singular
    value of its Jacobian over the moving joints (m and rad)."""

    q: Array
    name: str
    inside: bool
    sigma: float


@dataclass(frozen=True, slots=True)
class Solved:
    """The `status` of a target and its branches, those inside the limits first."""

    status: str
    branches: tuple[Branch, ...]

    def table(self, derivation: Derivation) -> str:
        """Markdown for people."""
        dh = derivation.reading.dh
        inside = sum(branch.inside for branch in self.branches)
        lines = [
            f"**{self.status}**: {inside} solutions inside the limits of {len(self.branches)}",
            "",
        ]
        for number, branch in enumerate(self.branches, start=1):
            joints = ", ".join(joint_text(dh, j, x) for j, x in enumerate(branch.q))
            outside = "" if branch.inside else "; outside the limits"
            lines.append(f"{number}. {branch.name}{outside}; σ {branch.sigma:.3f}: {joints}")
        return "\n".join(lines)


def solved(
    derivation: Derivation, runner: PythonModule, pose: Array, held: Array | None = None
) -> Solved:
    """All solutions of a pose (4, 4), those outside the limits too; `held` are values of held joints."""
    dh = derivation.reading.dh
    inside, status, _ = runner.solve(pose, free=held, limits=True)
    every, _, _ = runner.solve(pose, free=held, limits=False)
    rest = [q for q in every if not _among(q, inside)]
    rows = np.array([*inside, *rest]).reshape(-1, dh.dof)
    names = runner.branch_names(rows)
    moving = [j for j in range(dh.dof) if j not in derivation.module.free_indices]
    branches = []
    for i, (q, name) in enumerate(zip(rows, names, strict=True)):
        J = file_jacobian(dh, q)[:, moving]
        sigma = float(np.linalg.svd(J, compute_uv=False)[-1])
        branches.append(Branch(q, name, i < len(inside), sigma))
    return Solved(status, tuple(branches))


def _among(q: Array, rows: Array) -> bool:
    """Whether a row is one of others, whole turns aside."""
    apart = np.abs(np.exp(1j * rows) - np.exp(1j * q)).max(axis=1, initial=0.0)
    return bool(len(rows) and apart.min() < 1e-6)
