"""How the solutions of an eliminated arm arise: sixteen roots of one polynomial in the plane of complex
numbers, those on the unit circle being angles."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ikgen.elimination.plan import EliminationPlan
from ikgen.kinematics.forward import row_values
from ikgen.model.arrays import Array
from ikgen.model.dh import DHChain
from ikgen.report.document import Block, Paragraph, Picture
from ikgen.report.worked_example import WorkedExample
from ikgen.runtime.python.elimination.hidden_angle import loop_resultant
from ikgen.runtime.python.elimination.loop_equations import loop_constants, loop_equations
from ikgen.tasks import AXES

__all__ = ["hidden_roots", "loop_order", "roots_blocks"]

_SIZE, _UNIT = 360.0, 82.0
_EXTRANEOUS = 8
"""Roots at z = 0 and infinity that writing angles as half angles adds."""


def _hidden(plan: EliminationPlan) -> tuple[int, int]:
    """Where the loop begins and whether it is reversed: the resultant's choice, else the eigenproblem's."""
    return plan.resultants[0] if plan.resultants else plan.eliminations[0][:2]


def loop_order(dh: DHChain, plan: EliminationPlan) -> list[str]:
    """The names of the moving joints in the order in which the loop reads them."""
    names = [dh.joints[row.driver].name for row in dh.rows]
    moving = [name for name in names if name not in dh.free]
    start, reverse = _hidden(plan)
    if plan.tool is not None:
        moving.append(f"a turn about the tool's {AXES[plan.tool]} axis")
    return [moving[(start - i if reverse else start + i) % len(moving)] for i in range(len(moving))]


def hidden_roots(plan: EliminationPlan, pose: Array) -> tuple[int, int, NDArray[np.complex128]]:
    """The hidden joint (from 0), the sign with which the loop reads it, and the 16 roots z of det M, z the
    exponential of its angle: `(M0 - Mc) t^2 + 2 Ms t + M0 + Mc` is singular at t = tan(angle / 2), a
    quadratic eigenproblem (Manocha and Canny, 1994), here about an angle where M is far from singular."""
    start, reverse = _hidden(plan)
    order, C = loop_constants([*plan.frames[:, None]], pose[None], start, reverse)
    E, left, _ = loop_equations(C)
    M0, Mc, Ms = (part[0] for part in loop_resultant(E, left))
    nodes = 2 * np.pi / 7 * np.arange(7)
    pivots = [M0 - np.cos(a) * Mc - np.sin(a) * Ms for a in nodes]
    node = nodes[int(np.argmax([abs(np.linalg.det(p)) for p in pivots]))]
    c, s = np.cos(node), np.sin(node)
    c_turned, s_turned = c * Mc + s * Ms, c * Ms - s * Mc
    first = np.linalg.solve(M0 - c_turned, np.hstack([M0 + c_turned, 2 * s_turned]))
    block = np.block([[np.zeros((12, 12)), np.eye(12)], [-first]])
    t = np.linalg.eigvals(block)
    keep = np.argsort(np.minimum(abs(t - 1j), abs(t + 1j)))[_EXTRANEOUS:]
    z = (1 + 1j * t[keep]) / (1 - 1j * t[keep]) * np.exp(1j * node)
    return order[2], -1 if reverse else 1, z


def roots_blocks(dh: DHChain, plan: EliminationPlan, example: WorkedExample) -> list[Block]:
    """The figure, of an arm with six turning joints and none of them held."""
    if dh.free or len(dh.rows) != 6 or not all(row.revolute for row in dh.rows):
        return []
    joint, sign, roots = hidden_roots(plan, example.pose)
    angles = np.unique(np.round(sign * row_values(dh, example.rows)[:, joint], 6))
    words = (
        "The roots for the pose of the example: z is the exponential of the hidden angle, that of "
        f"{dh.joints[dh.rows[joint].driver].name}. Those on the unit circle are angles; each leads to a "
        f"solution ({len(example.rows)} here). The others come in pairs mirrored at the circle, "
        "and belong to no real configuration."
    )
    caption = "16 roots: dots on the circle are solutions, rings are not real"
    return [Paragraph((words,)), Picture(_drawing(roots, angles), "", caption)]


def _drawing(roots: NDArray[np.complex128], angles: Array) -> str:
    middle = _SIZE / 2
    real = np.exp(1j * angles)
    parts = [
        f'<circle class="line" cx="{middle:g}" cy="{middle:g}" r="{_UNIT:g}" fill="none" stroke="#345"/>',
        f'<path class="line" stroke="#345" stroke-opacity="0.35" d="M12 {middle:g}H{_SIZE - 12:g}'
        f'M{middle:g} 12V{_SIZE - 12:g}"/>',
        _words(middle + _UNIT + 5, middle - 5, "1"),
        _words(_SIZE - 50, middle - 5, "Re z"),
        _words(middle + 6, 22, "Im z"),
    ]
    for z in sorted(roots, key=lambda z: (round(abs(z), 6), round(float(np.angle(z)), 6))):
        # a root and its mirror image z / |z|^2 lie equally far from the circle, the farthest at 0 and 2
        far = _UNIT * 4 / math.pi * math.atan(abs(z))
        x, y = middle + far * math.cos(np.angle(z)), middle - far * math.sin(np.angle(z))
        if not np.any(np.abs(real - z) < 1e-3):
            parts.append(
                f'<circle class="line" cx="{x:.1f}" cy="{y:.1f}" r="4.5" fill="none" stroke="#345"/>'
            )
    for z in real:
        x, y = middle + _UNIT * z.real, middle - _UNIT * z.imag
        parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="5.5" fill="#e8973a" stroke="#48607a"/>')
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_SIZE:g} {_SIZE:g}" width="{_SIZE:g}" '
        f'height="{_SIZE:g}" role="img" font-family="sans-serif"><title>Roots of the elimination</title>'
        f"{''.join(parts)}</svg>"
    )


def _words(x: float, y: float, words: str) -> str:
    return (
        f'<text class="soft" x="{x:.1f}" y="{y:.1f}" font-size="12" fill="#55636f">{words}</text>'
    )
