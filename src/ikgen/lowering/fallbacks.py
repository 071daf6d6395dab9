"""Which of several forms gives an unknown's value at run time: by the size of their divisors."""

from __future__ import annotations

from dataclasses import replace

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.equations.knowledge import Variable
from ikgen.forms.lowered_form import ROUNDED, Divisor, LoweredForm, natural_size
from ikgen.lowering.placement import Placement
from ikgen.lowering.program_inputs import seed_values

__all__ = ["Flag", "choose_form", "picked"]

WELL_CONDITIONED = 1e-3
"""Relative size of a divisor below which a fallback is taken in its form's place."""

_LOST = 1e-2
"""Model error over the natural size of a divisor (an offset of 0.1 mm, say) above which it is never well
conditioned: hardly a digit of it is the file's."""

Flag = bool | Expr


def picked(g: ExpressionGraph, here: Expr | None, mine: Flag, other: Flag) -> Flag:
    """`mine` where the condition `here` holds (None: always), `other` elsewhere."""
    if here is None or mine is other:
        return mine
    missing = g.unary("not", here)
    if mine is True:
        return here if other is False else g.binary("or", here, _expr(other))
    if mine is False:
        return missing if other is True else g.binary("and", missing, _expr(other))
    if other is True:
        return g.binary("or", missing, mine)
    if other is False:
        return g.binary("and", here, mine)
    return g.binary("or", g.binary("and", here, mine), g.binary("and", missing, _expr(other)))


def _expr(flag: Flag) -> Expr:
    assert isinstance(flag, Expr)
    return flag


def choose_form(
    work: Placement, v: Variable, forms: list[LoweredForm], sigma: Expr
) -> tuple[Expr, ...]:
    """The first form whose divisor does not vanish; the seed's value if there is none.

    A small divisor gives but a rough value, and the last form's may be small where the first one's branches
    meet: all are tried for a large one first.
    """
    g = work.g
    divisors = [form.divisor for form in forms]
    first = [_well_conditioned(work, form) for form in forms[:-1] if not _lost(work, form)]
    last = forms[-1].divisor
    if len(forms) > 1 and last.clear is not None:
        wide = Divisor(last.value, last.clear, last.clear)
        forms = [*first, replace(forms[-1], divisor=wide), *forms]
    else:
        forms = [*first, forms[-1]]
    values = seed_values(work, v) if forms[-1].regular is not None else forms[-1].values
    guard: Flag = True
    single: Flag = True
    free: Flag = True
    for form in reversed(forms):
        here = form.regular
        guard = picked(g, here, True if form.guard is None else form.guard, guard)
        single = picked(g, here, form.branches == 1, single)
        clear = form.divisor.clear
        if clear is None or clear is here:  # never taken near a continuum
            free = picked(g, here, False, free)
        else:
            free = picked(g, here, g.unary("not", clear), free)
        if here is not None:
            both = zip(form.values, values, strict=True)
            values = tuple(g.select(here, mine, other) for mine, other in both)
        else:
            values = form.values
    if isinstance(guard, Expr):
        work.require_solution(guard, fold=True)
    if isinstance(single, Expr) and sigma is not g.one:
        work.require(g.binary("or", g.unary("not", single), g.binary("gt", sigma, g.zero)))
    if isinstance(free, Expr):
        work.place(free)
        work.singular.append(free)
    # divisors first: what they leave of the file is not less by the square root that goes with them
    work.note_divisors(divisors)
    for form in forms:
        if form.under is not None:
            work.note_fold(form.under[0], natural_size(form.under[1]))
    return values


def _lost(work: Placement, form: LoweredForm) -> bool:
    """Whether the file's geometry leaves no more of a form's divisor than of what it is off."""
    divisor = form.divisor
    error = work.model_error if work.model_error > ROUNDED else 0.0
    return divisor.magnitude is not None and error > _LOST * divisor.size ** (1.0 / divisor.power)


def _well_conditioned(work: Placement, form: LoweredForm) -> LoweredForm:
    """With a fallback behind it a form is left well before its divisor vanishes or its branches
    meet."""
    g = work.g
    well = min(max(WELL_CONDITIONED, 10.0 * work.model_error**0.5), 0.1)
    large = form.divisor.above(g, well)
    good: Flag = True if large is None else large
    if form.under is not None:
        limit = g.mul(g.const(well**2), form.under[1])
        apart = g.binary("gt", form.under[0], limit)
        good = apart if good is True else g.binary("and", _expr(good), apart)
    if good is True:
        return form
    divisor = Divisor(form.divisor.value, _expr(good), _expr(good))
    return LoweredForm(form.values, divisor, form.guard, form.branches)
