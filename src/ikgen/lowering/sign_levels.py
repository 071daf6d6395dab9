"""Levels of signs: how many tell the branches of a form apart, and the value that they choose."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.equations.knowledge import Variable
from ikgen.errors import PlugInError
from ikgen.forms.form import Form
from ikgen.forms.lowered_form import LoweredBranches, LoweredForm, LoweredRoutine
from ikgen.lowering.fallbacks import Flag, picked
from ikgen.lowering.placement import LoweredLevel, Placement

__all__ = ["add_levels", "as_one_each", "more_signs"]


def more_signs(g: ExpressionGraph, step: int, branches: int) -> tuple[Expr, ...]:
    """The signs by which more than two branches of a step are told apart: as many as halve them to one."""
    return tuple(
        g.atom("sigma", f"{step}_{k}", np.ones(g.probes), unknown=False)
        for k in range((branches - 1).bit_length())
    )


def add_levels(work: Placement, v: Variable, signs: Sequence[Expr]) -> None:
    """A level of each of an unknown's signs."""
    for k, sign in enumerate(signs, start=1):
        work.levels.append(LoweredLevel(2, sign))
        work.level_of[sign.id] = len(work.levels) - 1
        work.names[sign.id] = f"sigma_{v.index}" + (f"_{k}" if len(signs) > 1 else "")


def as_one_each(
    g: ExpressionGraph,
    forms: Sequence[Form],
    lowered: Sequence[LoweredForm | LoweredBranches | LoweredRoutine],
    signs: Sequence[Expr],
) -> list[LoweredForm]:
    """What the signs choose of each form, without those that a routine solves.

    Raises `PlugInError` for a form that does not give as many branches as it has.
    """
    both = zip(forms, lowered, strict=True)
    return [_as_one(g, form, x, signs) for form, x in both if not isinstance(x, LoweredRoutine)]


def _as_one(
    g: ExpressionGraph, form: Form, lowered: LoweredForm | LoweredBranches, signs: Sequence[Expr]
) -> LoweredForm:
    if isinstance(lowered, LoweredForm):
        if form.branches > 2:
            raise PlugInError(
                f"{form.words} has {form.branches} branches, of which one sign tells but two apart",
                hint="its `lower` has to give each of them in a `LoweredBranches`",
            )
        return lowered
    given = len(lowered.values), len(lowered.guards)
    if given != (form.branches, form.branches):
        raise PlugInError(
            f"{form.words} has {form.branches} branches and gives {given[0]} values and {given[1]} guards",
            hint="`LoweredBranches` has both of each branch",
        )
    guard = _allowed(g, signs, [True if one is None else one for one in lowered.guards])
    return LoweredForm(
        tuple(_chosen(g, signs, parts) for parts in zip(*lowered.values, strict=True)),
        lowered.divisor,
        guard if isinstance(guard, Expr) else None,
        form.branches,
        lowered.under,
    )


def _halves(signs: Sequence[Expr], of: Sequence[Any]) -> tuple[Sequence[Any], Sequence[Any]]:
    """What the first sign chooses between: what comes first where it is +1."""
    half = 1 << (len(signs) - 1)
    return of[:half], of[half:]


def _chosen(g: ExpressionGraph, signs: Sequence[Expr], values: Sequence[Expr]) -> Expr:
    """The value of the branch that the signs choose; any where there is none."""
    if len(values) == 1:
        return values[0]
    halves = [_chosen(g, signs[1:], x) for x in _halves(signs, values) if x]
    if len(halves) == 1:
        return halves[0]
    first, second = halves
    return g.select(g.binary("gt", signs[0], g.zero), first, second)


def _allowed(g: ExpressionGraph, signs: Sequence[Expr], guards: Sequence[Flag]) -> Flag:
    """The guard of the branch that the signs choose, which does not hold where there is none."""
    if not guards:
        return False
    if not signs:
        return guards[0]
    first, second = (_allowed(g, signs[1:], x) for x in _halves(signs, guards))
    return picked(g, g.binary("gt", signs[0], g.zero), first, second)
