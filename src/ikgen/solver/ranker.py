"""The ranker: which of several candidates to take (IKBT's "Ranker" node).

A candidate is judged at the probes. It must reproduce the generating configurations; one whose divisor
vanishes at a regular configuration comes last; then fewer branches, the better form, the cheaper.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ikgen.algebra.expression import Expr
from ikgen.equations.probes import Probes
from ikgen.solver.candidate import Candidate, Judgement
from ikgen.solver.leaves import LEAVES

__all__ = ["WEAK_MARGIN", "judge", "rank_key", "why_not"]

_NAMES = [name for leaf in LEAVES for name in leaf.finds]
_RANKS = {name: rank for rank, name in enumerate(_NAMES)}
_TANGENT = _RANKS["tangent"]
_STRANGER = len(_RANKS)

MATCH = 1e-5
FOLD_MARGIN = 1e-9
"""Relative size of a discriminant below which two branches count as one."""

_THIN_MARGIN = 0.1
"""Relative size of a determinant at a regular configuration below which a sum of squares is the better
divisor, if there is a choice: that vanishes where the arm is singular alone, a determinant on a surface
through it."""

WEAK_MARGIN = 1e-6
"""Relative size of a divisor below which a probe counts as one where it vanishes."""


_PAIRED = 1e-3
"""Steepness of an equation at its roots, at half of the probes, below which these lie in pairs: it is the
square of another but for rounding, and a root of it keeps half of the digits everywhere."""


def judge(
    candidate: Candidate,
    truth: tuple[NDArray[np.float64], ...],
    probes: Probes,
    used: set[int],
    weight: Callable[[int], float],
) -> Candidate | None:
    """The candidate with its judgement, or None if it is not a solution.

    `truth` is the unknown at the probes, (c, s) or (x,); `weight` says for how many branches an expression
    with a support is computed.
    """
    generic, regular = probes.generic, probes.regular
    relative = candidate.relative_divisor()
    if np.median(relative[:generic]) < 1e-6:
        return None
    matches = np.zeros(len(relative), dtype=bool)
    for branch in candidate.values():
        with np.errstate(all="ignore"):
            error = sum(np.abs(b - t) for b, t in zip(branch, truth, strict=True))
        matches |= error < MATCH * (1 + sum(np.abs(t) for t in truth))
    if not matches[:generic].all():
        return None
    margin = float(relative[:regular].min())
    steepness = _steepness(candidate, truth, regular)
    weak = bool((~matches[:regular]).any() or margin < WEAK_MARGIN or steepness < _PAIRED)
    singular = relative[regular:]
    fragile = float((singular < WEAK_MARGIN).mean()) if singular.size else 0.0
    cost = _cost(candidate.coefficients, used, weight)
    almost = bool(probes.kept) and _almost_tangent(candidate, generic)
    folds = _folds(candidate, regular)
    judgement = Judgement(weak, folds, margin, fragile, cost, almost, steepness)
    return replace(candidate, judgement=judgement)


def _steepness(candidate: Candidate, truth: tuple[NDArray[np.float64], ...], regular: int) -> float:
    """How steep the form's equation is at its roots, at half of the probes; infinite where no routine
    solves it."""
    steep = candidate.form.steepness(truth)
    return math.inf if steep is None else float(np.median(steep[:regular]))


def _almost_tangent(candidate: Candidate, generic: int) -> bool:
    """Whether the form's constant side is zero where rounded constants have the values that were meant."""
    constant = candidate.form.tangent_without
    if constant is None:
        return False
    return bool(np.abs(constant.probe[generic:]).max() <= FOLD_MARGIN * constant.scale)


def _folds(candidate: Candidate, regular: int) -> bool:
    """Whether the candidate's branches meet at a regular configuration: its square root loses half the
    digits where the arm itself is well-behaved, so one of the branches must be spurious."""
    under = candidate.form.discriminant()
    return under is not None and bool(np.min(under[:regular]) < FOLD_MARGIN)


def _cost(roots: tuple[Expr, ...], used: set[int], weight: Callable[[int], float]) -> float:
    """Operations not yet computed, each times the number of branches it is computed for."""
    seen: set[int] = set()
    total = 0.0
    stack = list(roots)
    while stack:
        node = stack.pop()
        if node.id in seen or node.id in used or not node.args or node.is_fixed:
            continue
        seen.add(node.id)
        total += weight(node.support) if node.op != "neg" else 0.25
        stack.extend(node.args)
    return total


def _form_rank(candidate: Candidate, judged: Judgement) -> int:
    return _TANGENT if judged.almost_tangent else _RANKS.get(candidate.leaf, _STRANGER)


_EQUAL = "equal, later in order"
_MORE_BRANCHES = "more branches"
_PASSED_OVER = "not found to hold at all regular configurations"

_CRITERIA: tuple[tuple[Callable[[Candidate, Judgement], Any], str], ...] = (
    (lambda c, j: not c.is_sound, "fails or folds at some regular configurations"),
    (lambda c, j: c.branches, _MORE_BRANCHES),
    (_form_rank, "a less direct form"),
    (lambda c, j: round(j.fragile, 1), "degenerate at more singular configurations"),
    (
        lambda c, j: j.margin < _THIN_MARGIN and c.form.is_determinant,
        "divides by a determinant that is nearly zero at some regular configurations",
    ),
    (
        lambda c, j: c.branches == 1 and sum(e.squared for e in c.sources),
        "squared equations, which add spurious solutions",
    ),
    (lambda c, j: j.cost, "more to compute"),
    (lambda c, j: tuple(-k for k in c.unknown.combination), _EQUAL),
    (lambda c, j: tuple(e.id for e in c.coefficients), _EQUAL),
)
"""What is compared, in order, less being better; and what is wrong with a candidate that has more."""


def rank_key(candidate: Candidate) -> tuple[Any, ...]:
    """Sort key: smaller is better."""
    judged = candidate.judgement
    assert judged is not None
    return tuple(of(candidate, judged) for of, _ in _CRITERIA)


def why_not(other: Candidate, best: Candidate) -> str:
    """Why a candidate was not taken where `best` was, in words: it ranks behind that, or the chooser passed
    over it."""
    words = (more for _, more in _CRITERIA)
    for more, its, mine in zip(words, rank_key(other), rank_key(best), strict=True):
        if its > mine:
            return more
        if its < mine:
            return _MORE_BRANCHES if other.branches > best.branches else _PASSED_OVER
    return _EQUAL
