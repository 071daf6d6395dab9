"""Lower a solution graph to a Program: one lowering for every language."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ikgen.algebra.expression import Expr
from ikgen.equations.knowledge import Variable
from ikgen.errors import PlugInError
from ikgen.forms.form import Form
from ikgen.forms.lowered_form import ROUNDED, LoweredForm, LoweredRoutine, natural_size
from ikgen.kinematics.whole_turns import middle_of
from ikgen.lowering.closure import require_closure
from ikgen.lowering.elbow_position import bind_elbow
from ikgen.lowering.fallbacks import choose_form
from ikgen.lowering.joint_values import joint_expression
from ikgen.lowering.placement import LoweredLevel, Placement, local_name
from ikgen.lowering.program_inputs import bind_joints, bind_pose, seed_values
from ikgen.lowering.serialize import serialize
from ikgen.lowering.sign_levels import add_levels, as_one_each, more_signs
from ikgen.program.inputs import HeldValue
from ikgen.program.liveness import trimmed
from ikgen.program.routines import ROUTINES, Routine
from ikgen.program.statements import Comment, Program
from ikgen.solver.choice import Step
from ikgen.solver.solution_graph import SolutionGraph

__all__ = ["lower"]

_COARSE = 1e-9
"""Bound on what a joint value is off (rad or m) above which most of its rows are not right as they are."""


def lower(graph: SolutionGraph, *, model_error: float = 0.0, shortened: float = 0.0) -> Program:
    """The Program of a solution graph.

    `model_error` is how far (m or rad) the file's geometry may be off the exact one that was solved: square
    roots and the final check give way by that much, and rows are refined on the file's chain. `shortened`:
    by how much a tilt of the tool takes the squared length of a heading from 1, at most.
    """
    work = Placement(graph, model_error)
    bind_pose(work)
    bind_joints(work)
    bind_elbow(work)
    for index, step in enumerate(graph.steps):
        _step(work, index, step)
    values = _joint_values(work)
    require_closure(work, shortened)
    _place_values(work, values)
    return replace(trimmed(serialize(work, values)), coarse=_coarse(work, values))


def _coarse(work: Placement, values: list[tuple[int, Expr]]) -> bool:
    """Whether round-off alone takes joint values too far off, at half of the probes."""
    errors = [work.rounding.of(e) for j, e in values if j not in work.held]
    return bool(np.median(np.nan_to_num(np.max(errors, axis=0), nan=np.inf)) > _COARSE)


def _step(work: Placement, index: int, step: Step) -> None:
    """One solved unknown: by a form whose branches signs tell apart, or by a routine."""
    g = work.g
    v = step.candidate.unknown
    text = f"{v.text}: {step.candidate.leaf}, from {_labels(step)}"
    sigma = g.one
    if step.branches == 2:
        sigma = g.atom("sigma", str(index), np.ones(g.probes), unknown=False)
    forms = [c.form for c in (step.candidate, *step.fallbacks)]
    lowered = [form.lower(g, sigma, work.tolerances) for form in forms]
    if isinstance(lowered[0], LoweredRoutine):
        _routine(work, v, forms[0], lowered[0], text)
        return
    signs: tuple[Expr, ...] = () if sigma is g.one else (sigma,)
    if step.branches > 2:
        signs = more_signs(g, index, step.branches)
    add_levels(work, v, signs)
    work.place(Comment(text))
    alternatives = as_one_each(g, forms, lowered, signs)
    work.define(v, choose_form(work, v, alternatives, sigma))
    for level in work.levels[len(work.levels) - len(signs) :]:
        level.solved = work.atoms_of(v)
    if v.kind == "angle" and (
        not all(form.on_circle for form in forms) or _given_way(work, alternatives)
    ):
        work.norms.append(_excess(work, v))


def _given_way(work: Placement, forms: list[LoweredForm]) -> bool:
    """Whether a square root may have been taken of what is far outside its domain, unseen: other equations
    need not tell it, as those of a task that reads too few entries. Rows of a rounded file for a whole pose
    are refined, whatever they are."""
    tol = work.tolerances
    sizes = [(f.under[0], natural_size(f.under[1])) for f in forms if f.under]
    far = tol.rough is not None or any(
        tol.folded(e) is not None or tol.least(e, x) > tol.clamp * x for e, x in sizes
    )
    return far and bool(sizes) and not (work.whole_pose and work.model_error > ROUNDED)


def _excess(work: Placement, v: Variable) -> Expr:
    """Two linear equations give a cosine and sine on the unit circle only if they agree with the
    rest: a branch whose squares do not add up to one is none."""
    g = work.g
    c, s = work.knowledge.variables.pair(v.combination)
    return g.sub(g.add(g.square(c), g.square(s)), g.one)


def _routine(work: Placement, v: Variable, form: Form, lowered: LoweredRoutine, text: str) -> None:
    """A level whose branches are the roots that a routine of the runtime finds."""
    arguments = _or_seed(work, v, form, lowered)
    for e in arguments:
        work.place(e)
    atoms = work.knowledge.variables.pair(v.combination)
    call = (_known_routine(form, lowered.routine), arguments, atoms)
    work.levels.append(LoweredLevel(form.branches, None, call))
    work.place(Comment(text))
    for atom, x in zip(atoms, "cs", strict=True):
        work.names[atom.id] = local_name(f"{x}{v.index}")
        work.level_of[atom.id] = len(work.levels) - 1
        work.placed.add(atom.id)
    slope = work.slope(v, form)
    if slope is not None:
        work.note_root(atoms, form.pattern(work.g, atoms)[0], slope)


def _known_routine(form: Form, name: str) -> Routine:
    """The routine of a name. Raises `PlugInError` where there is none that finds roots of one unknown."""
    known = {one.name: one for one in ROUTINES.values() if one.finds_roots}
    if name not in known:
        raise PlugInError(
            f"{form.words} is to be solved by a routine '{name}', which ikgen does not have",
            hint=f"there is: {', '.join(known)}",
        )
    return known[name]


def _or_seed(work: Placement, v: Variable, form: Form, lowered: LoweredRoutine) -> tuple[Expr, ...]:
    """The routine's arguments, and where its divisor vanishes those whose solution is the seed's value."""
    g, divisor = work.g, lowered.divisor
    if divisor.regular is None or divisor.clear is None:
        return lowered.arguments
    missing = g.unary("not", divisor.clear)
    work.place(missing)
    work.singular.append(missing)
    instead = form.instead(g, seed_values(work, v))
    instead = (*instead, *lowered.arguments[len(instead) :])
    both = zip(lowered.arguments, instead, strict=True)
    return tuple(g.select(divisor.regular, mine, other) for mine, other in both)


def _joint_values(work: Placement) -> list[tuple[int, Expr]]:
    """Every joint's value, base to tip; what they are made of is placed."""
    out: list[tuple[int, Expr]] = []
    work.place(Comment("joint variables"))
    for j in range(work.dh.dof):
        if j in work.held:
            out.append((j, work.atom(HeldValue(j).name)))
            continue
        v = work.knowledge.joint_variable(j)
        if v.kind == "angle":
            variable: tuple[Expr, ...] | None = work.knowledge.known_pair(v.combination)
            assert variable is not None
        else:
            variable = (work.knowledge.variables.distance(j),)
        for e in variable:
            work.place(e)
        out.append((j, _value(work, j, variable)))
    return out


def _place_values(work: Placement, values: list[tuple[int, Expr]]) -> None:
    """After the guards: a branch without a solution needs none of them."""
    work.place(Comment("joint values"))
    for j, e in values:
        if j not in work.held:
            work.names.setdefault(e.id, f"q{j + 1}")
            work.place(e)


def _labels(step: Step) -> str:
    return " and ".join(dict.fromkeys(e.label for e in step.candidate.sources))


def _value(work: Placement, joint: int, variable: tuple[Expr, ...]) -> Expr:
    """A joint's value from its DH variable."""
    middle = middle_of(work.dh, joint)
    return joint_expression(work.g, work.dh.lead_row(joint), variable, middle)
