"""The last guard of a Program: a row is returned only if it reproduces the pose."""

from __future__ import annotations

import numpy as np

from ikgen.algebra.expression import Expr
from ikgen.equations.probes import arm_size
from ikgen.forms.lowered_form import ROUNDED
from ikgen.lowering.double_roots import either
from ikgen.lowering.placement import Placement
from ikgen.program.statements import Comment

__all__ = ["require_closure"]

CHECK_TOLERANCE = 1e-6
"""Largest error (m over the arm's size, rad) of a row that may become a solution: near singularities
the closed form loses digits, which Newton steps win back."""

_WIDER = 1000.0
"""As many times as large where an unknown may have lost digits: each step that follows from it may multiply
what it is off, and which does is known of no single one. Newton steps tell."""

_TILTED = 2.0
"""Error of a row (rad) over what its heading's squared length is short of, at most."""

_UNSEEN = 1e-12
"""Round-off (rad, m) that rows may keep near folds too. Where it leaves more, it does so in most rows:
those far from folds stay as they are."""

_SHARE = 1e-4
"""What a squared error counts away from folds then: it moves a row by no more than itself over the smallest
singular value."""


def require_closure(work: Placement, shortened: float = 0.0) -> None:
    """A row is returned only if it reproduces the pose: the cheapest split is compared. A heading counts
    for where it points, though a tilt of the tool has `shortened` its squared length by so much."""

    def cost(parts: tuple[list[Expr], list[Expr]]) -> float:
        return work.price([*parts[0], *parts[1]])

    n = work.system.n
    splits = [(0, n)]
    if work.whole_pose:
        splits = [(k, m) for k in range(n) for m in range(k + 1, n + 1)]
    residuals = min((_residuals(work, k, m) for k, m in splits), key=cost)
    work.place(Comment("does the row reproduce the pose?"))
    limit = max(CHECK_TOLERANCE, min(1000 * work.model_error, 0.2))
    turned = max(limit, _TILTED * shortened)
    size = max(arm_size(work.dh), 1.0)
    for level in range(len(work.levels)):
        norms = [e for e in work.norms if work.level(e) == level]
        _bounded(work, norms, turned)
    for parts, least, scale in zip(residuals, (limit, turned), (size, 1.0), strict=True):
        _bounded(work, parts, least, scale)


def _bounded(work: Placement, parts: list[Expr], limit: float, scale: float = 1.0) -> None:
    """Squared parts are bounded by the square of the limit, times a scale, and wider where a divisor, or
    what a root is taken of, nearly vanishes. Where the Program loses digits all along the limit is wider
    everywhere, and there again for roots alone: a vanishing divisor's branches that do not hold are starts
    of Newton steps as well, unless others hold."""
    if not parts:
        return
    g, total = work.g, work.g.dot(parts, parts)
    least = max(limit, _WIDER * CHECK_TOLERANCE) if work.loses_digits else limit
    wider = [(dict.fromkeys((*work.singular, *work.close)), limit)]
    if least > limit:
        wider = [(dict.fromkeys(work.close), least), (dict.fromkeys(work.singular), limit)]
    most = g.const((scale * least) ** 2)
    for flags, bound in wider:
        some = either(g, flags)
        if some is not None:
            most = g.select(some, g.const((scale * _WIDER * bound) ** 2), most)
    work.require_solution(g.binary("gt", most, total))
    work.residuals.append(_counted(work, parts, total))


def _counted(work: Placement, parts: list[Expr], total: Expr) -> Expr:
    """Squared parts as they count where a row is to be refined: less away from folds, where round-off alone
    leaves much."""
    g = work.g
    off = max(float(np.median(work.rounding.of(e))) for e in parts)
    if off < _UNSEEN or work.model_error > ROUNDED:
        return total
    close = either(g, work.close)
    if close is None:
        return total
    counted = g.mul(total, g.select(close, g.one, g.const(_SHARE)))
    work.place(counted)
    return counted


def _residuals(work: Placement, k: int, m: int) -> tuple[list[Expr], list[Expr]]:
    """Differences of position and of rotation of one split, those that vanish by construction
    and those that the task does not read left out."""
    left, right = work.system.left(k, m), work.system.right(k, m)
    position = list(zip(left.p, right.p, strict=True))
    rotation = [(left.R[i][j], right.R[i][j]) for i in range(3) for j in range(3)]
    return _differences(work, position), _differences(work, rotation)


def _differences(work: Placement, pairs: list[tuple[Expr, Expr]]) -> list[Expr]:
    g = work.g
    out: list[Expr] = []
    for a, b in pairs:
        if not work.knowledge.known_expr(a) or not work.knowledge.known_expr(b):
            continue
        if g.sub(_meaning(work, a), _meaning(work, b)) is not g.zero:
            out.append(g.sub(a, b))
    return out


def _meaning(work: Placement, entry: Expr) -> Expr:
    """What an entry stands for, a solved unknown's sine or cosine with either sign."""
    if entry.op == "neg":
        return work.g.neg(work.defined(entry.args[0]))
    return work.defined(entry)
