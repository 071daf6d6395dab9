"""What is left where the solver got stuck: the equations, and the leaf that came nearest."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from ikgen.algebra.expression import Expr
from ikgen.equations.equation import Equation
from ikgen.equations.knowledge import UNREADABLE, Knowledge, PolynomialEquation, Variable
from ikgen.solver.solution_graph import SolutionGraph

__all__ = ["NearMiss", "OpenEquation", "count_open", "near_misses", "open_equations"]


@dataclass(frozen=True, slots=True)
class OpenEquation:
    """An equation that holds unknowns still; `rank` is how many of them are independent."""

    equation: Equation
    polynomial: PolynomialEquation
    size: int

    @property
    def rank(self) -> int:
        """Number of independent unknowns."""
        return self.polynomial.rank

    @property
    def unknowns(self) -> tuple[Variable, ...]:
        """The unknowns, sums of angles among them."""
        return self.polynomial.unknowns


@dataclass(frozen=True, slots=True)
class NearMiss:
    """The leaf that an equation would suit for `unknown`, had it not the unknowns `lacking` as well."""

    leaf: str
    unknown: Variable
    lacking: tuple[Variable, ...]
    source: OpenEquation


def _open(k: Knowledge) -> Iterator[tuple[int, Equation]]:
    """The equations with unknowns, each once, and how many are independent; without those that hold
    entries that the task does not read."""
    told: set[tuple[int, int]] = set()
    for e in k.equations.equations:
        sides = (e.left.id, e.right.id)
        rank = k.unknown_rank(e.left.support | e.right.support)
        if sides not in told and rank not in (0, UNREADABLE):
            told.add(sides)
            yield rank, e


def count_open(graph: SolutionGraph) -> int:
    """How many equations hold unknowns still."""
    return sum(1 for _ in _open(graph.workspace()))


def open_equations(
    graph: SolutionGraph, size: Callable[[Expr], int], most: int = 40
) -> list[OpenEquation]:
    """Up to `most` equations with unknowns, those with the fewest first and of these the shortest
    (`size` of both sides)."""
    k = graph.workspace()
    ranked = [(rank, size(e.left) + size(e.right), e.label, e) for rank, e in _open(k)]
    found: list[OpenEquation] = []
    for _, length, _, e in sorted(ranked, key=lambda x: x[:3]):
        p = k.polynomial_equation(e)
        if p.unknowns:
            found.append(OpenEquation(e, p, length))
        if len(found) == most:
            break
    return sorted(found, key=lambda o: (o.rank, len(o.unknowns), o.size, o.equation.label))


def near_misses(equations: list[OpenEquation]) -> list[NearMiss]:
    """What each equation could be solved for if its other unknowns were known, nearest first: fewest
    lacking, then the simplest form, then the shortest."""
    misses = [
        (len(o.unknowns) - 1, _degree(o.polynomial, v), o.size, i, v)
        for i, o in enumerate(equations)
        for v in o.unknowns
    ]
    out = []
    for _, degree, _, i, v in sorted(misses):
        o = equations[i]
        lacking = tuple(u for u in o.unknowns if u != v)
        out.append(NearMiss(_leaf(v, degree), v, lacking, o))
    return out


def _degree(p: PolynomialEquation, v: Variable) -> int:
    """Degree of the equation in an unknown: in its cosine and sine, or in the length."""
    if v.kind == "prismatic":
        joint = v.combination.index(1)
        return max((n for _, slides in p.polynomial for j, n in slides if j == joint), default=0)
    return max(
        (
            sum(combination == v.combination for combination, _ in trigs)
            for trigs, _ in p.polynomial
        ),
        default=0,
    )


def _leaf(v: Variable, degree: int) -> str:
    if v.kind == "prismatic":
        return "algebraic" if degree <= 1 else "quadratic"
    return "sine and cosine" if degree <= 1 else "quartic"
