"""One section an unknown: the equations chosen, the solution, its branches, what was rejected."""

from __future__ import annotations

from dataclasses import dataclass

from ikgen.equations.equation import Equation
from ikgen.equations.knowledge import Knowledge, Variable
from ikgen.forms.formula import Formula, FormulaWriter
from ikgen.formulas import mathtext as m
from ikgen.formulas.mathtext import Math
from ikgen.formulas.naming import Abbreviations
from ikgen.formulas.normal_form import Sum
from ikgen.formulas.normalizer import Normalizer
from ikgen.formulas.notation import show, variable
from ikgen.report.candidate_table import candidates_table
from ikgen.report.document import Block, Fold, Formulas, Heading, Inline, Paragraph, Rows, Text
from ikgen.report.leaf_words import leaf_sentence
from ikgen.report.solution_sets import Versions
from ikgen.report.splits import equation_anchor, origin, place
from ikgen.report.step_anchor import step_anchor
from ikgen.solver.candidate import Candidate
from ikgen.solver.choice import Step
from ikgen.solver.solution_graph import SolutionGraph

__all__ = ["Writer", "abbreviations", "derived_section", "step_section"]

_MANY = 16


@dataclass(frozen=True, slots=True)
class Writer:
    """What all step sections share."""

    graph: SolutionGraph
    known: Knowledge
    versions: Versions
    normal: Normalizer
    names: Abbreviations


def abbreviations(graph: SolutionGraph, normal: Normalizer) -> Abbreviations:
    """Names for what comes again in the solutions of all unknowns."""
    formulas: list[Sum] = []
    for step in graph.steps:
        for c in (step.candidate, *step.fallbacks):
            formulas += [normal(e) for e in c.coefficients]
    return Abbreviations(formulas)


def step_section(w: Writer, number: int, step: Step) -> list[Block]:
    """One solved unknown."""
    c = step.candidate
    v = variable(c.unknown)
    title: Text = (f"{number}. ", v, f": {c.leaf}")
    solved = _formula(w, c)
    blocks: list[Block] = [Heading(title, 2, step_anchor(c.unknown))]
    blocks += [*leaf_sentence(c.leaf), *_origin(w, c)]
    shown = [e for e in dict.fromkeys(c.sources) if _short(w, e)]
    if shown:
        written = tuple(_equation(w, e) for e in shown)
        blocks += [Paragraph(("that is:",)), Formulas(written, tuple(map(equation_anchor, shown)))]
    if solved.equations:
        blocks += [Paragraph(("In the unknown:",)), Formulas(solved.equations)]
    news = w.names.news()
    solution = _solution(w, c, solved)
    news += w.names.news()
    if news:
        lines = [m.name("u", str(n.index)) + m.relation() + show(s) for n, s in news]
        blocks += [Paragraph(("with",)), Formulas(tuple(lines))]
    blocks += [Paragraph(("Solution:",)), Formulas(solution)]
    if c.form.remark:
        blocks.append(Paragraph(c.form.remark))
    blocks += _versions(w, c.unknown, step.branches)
    blocks += _guards(step, solved)
    for fallback in step.fallbacks:
        blocks += _fallback(w, fallback)
    return blocks + candidates_table(step)


def _formula(w: Writer, c: Candidate) -> Formula:
    writer = FormulaWriter(c.unknown, c.coefficients, w.known.graph, w.normal, w.names)
    return c.form.formula(writer)


def _origin(w: Writer, c: Candidate) -> list[Block]:
    made = origin(w.known.equations, c.sources)
    note = [Paragraph((f"By {c.note or c.leaf}:",))] if c.note or not made else []
    return [*made, *note]


def _equation(w: Writer, e: Equation) -> Math:
    left, right = (w.names.inside(w.normal(side)) for side in (e.left, e.right))
    return show(left) + m.relation() + show(right)


def _short(w: Writer, e: Equation) -> bool:
    return w.normal(e.left).weight + w.normal(e.right).weight < 120


def _solution(w: Writer, c: Candidate, solved: Formula) -> tuple[Math, ...]:
    several = len(solved.branches) > 1
    alone = w.versions.count(c.unknown) == len(solved.branches)
    lines = []
    for i, branch in enumerate(solved.branches, start=1):
        version = f"s{i}" if several and alone else ""
        left = variable(c.unknown, version)
        if several and not alone:
            left = variable(c.unknown) + m.text(f" (branch {i})")
        lines.append(left + m.relation() + branch)
    return tuple(lines)


def _versions(w: Writer, v: Variable, branches: int) -> list[Block]:
    """Which version of an unknown comes from which versions of its parents."""
    count = w.versions.count(v)
    parents = [p for p in w.versions.parents[v] if p in w.versions.within]
    if count == branches or not parents:
        return []
    forks = w.versions.within[v]
    lead: list[Inline] = [f"{count} solutions, from those of "]
    for i, p in enumerate(parents):
        lead += [", " if i else "", variable(p)]
    own = [f for f in forks if w.versions.forks[f][0] == v]
    if count > _MANY:
        return [Paragraph((*lead, "."))]
    rows = []
    for choice in w.versions.choices(v):
        chosen = dict(zip(forks, choice, strict=True))
        cells: list[Text] = [(variable(v, w.versions.label(v, chosen)),)]
        cells += [(variable(p, w.versions.label(p, chosen)),) for p in parents]
        if own:
            cells.append((str(chosen[own[0]] + 1),))
        rows.append(tuple(cells))
    header: list[Text] = [("solution",), *(("from ", variable(p)) for p in parents)]
    header += [("branch",)] if own else []
    table = Rows(tuple(header), tuple(rows), small=True)
    words = f"The {count} solutions and what each is computed from"
    return [Paragraph((*lead, ".")), Fold(words, (table,))]


def _guards(step: Step, solved: Formula) -> list[Block]:
    out: list[Block] = []
    if solved.reach is not None:
        relation = any(t.role == "rel" for t in solved.reach.tokens)
        condition = solved.reach
        if not relation:
            condition = condition + m.relation("\\ge ", "≥") + m.name("0")
        out.append(
            Paragraph(("Reachable only where ", condition, "; on the boundary the branches meet."))
        )
    if solved.divisor is not None:
        v = variable(step.candidate.unknown)
        end = (
            "another form is taken there (below)."
            if step.fallbacks
            else (
                "the seed's value is tried there (0 without one); only rows that give the pose are "
                "returned, flagged singular where the arm itself is."
            )
        )
        out.append(
            Paragraph(
                (
                    "Degenerate where ",
                    solved.divisor + m.relation() + m.name("0"),
                    ": ",
                    v,
                    " does not follow; ",
                    end,
                )
            )
        )
    return out


def _fallback(w: Writer, c: Candidate) -> list[Block]:
    solved = _formula(w, c)
    news = w.names.news()
    lines = [m.name("u", str(n.index)) + m.relation() + show(s) for n, s in news]
    places = ", and ".join(dict.fromkeys(place(e) for e in c.sources))
    lead = Paragraph((f"Where that divisor vanishes: {c.leaf}, from {places}:",))
    return [lead, Formulas((*solved.equations, *lines, *_solution(w, c, solved)))]


def derived_section(w: Writer) -> list[Block]:
    """Joints that follow from sums of solved angles."""
    solved = {step.candidate.unknown for step in w.graph.steps}
    lines = []
    for v, _ in w.graph.parents:
        composed = v.kind == "angle" and w.known.composition(v.combination)
        if v in solved or not composed or composed == ((1, v.combination),):
            continue
        right = Math(())
        for factor, combination in composed:
            sign = m.minus(sign=not right.tokens) if factor < 0 else m.plus()
            right = right + (sign if right.tokens or factor < 0 else Math(()))
            right = right + (m.number(abs(factor)) if abs(factor) != 1 else Math(()))
            right = right + variable(Variable("angle", combination))
        lines.append(variable(v) + m.relation() + right)
    if not lines:
        return []
    return [
        Heading(("Sums of angles",), 2, "sums"),
        Paragraph(("Linear relations give the other joints:",)),
        Formulas(tuple(lines)),
    ]
