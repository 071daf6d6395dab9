"""Where expressions are computed: each at the outermost level that its dependencies allow."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import partial, reduce

import numpy as np
from numpy.typing import NDArray

from ikgen.algebra.dependencies import dependencies
from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.equations.knowledge import Variable
from ikgen.forms.form import Form
from ikgen.forms.lowered_form import Divisor, Tolerances, natural_size
from ikgen.lowering.double_roots import DoubleRoots, either
from ikgen.lowering.file_digits import FileDigits
from ikgen.lowering.rounding import Rounding
from ikgen.program.inputs import Input
from ikgen.program.routines import Routine
from ikgen.program.statements import Comment, Let
from ikgen.solver.choice import Step
from ikgen.solver.solution_graph import SolutionGraph
from ikgen.tasks import WHOLE_POSE

__all__ = ["LoweredLevel", "Placement", "Requirement", "local_name"]


FOLDED = 1e-6
"""Relative size of what is under a square root below which its root has lost too many digits."""


_CROWDED = 0.1
"""Steepness of an equation at its roots below which two of them may meet next to regular configurations."""


@dataclass(frozen=True, slots=True)
class Requirement:
    """A condition without which the branch has no solution; `fold`: it bounds where the solution is
    real."""

    condition: Expr
    fold: bool = False


@dataclass
class LoweredLevel:
    """Expressions, guards and comments of one level, in order."""

    branches: int
    sigma: Expr | None = None
    call: tuple[Routine, tuple[Expr, ...], tuple[Expr, ...]] | None = None
    solved: tuple[Expr, ...] = ()
    items: list[Expr | Comment | Requirement] = field(default_factory=list)


class Placement:
    """The levels of a Program under construction, and what is known of every expression in them.

    `model_error` (m or rad) is how far the file's geometry is off the solved one; `norms` are excesses that
    vanish on a solution, `residuals` squared errors of a row, `singular` flags of continua, `lost`
    conditions under which a direction has nothing of the file's, `hidden` flags of branches that fail then,
    `doubts` conditions under which the file's arm may have solutions that no branch leads to.
    """

    def __init__(self, graph: SolutionGraph, model_error: float) -> None:
        self.dh, self.held, self.probes = graph.dh, graph.held, graph.probes
        self.knowledge = graph.workspace()
        self.system = self.knowledge.equations
        self.g: ExpressionGraph = self.knowledge.graph
        self.model_error = model_error
        self.definition: dict[int, Expr] = dict(self.knowledge.binding)
        self.rounding = Rounding(graph.probes.generic, self.definition)
        self._levers = Rounding(graph.probes.generic, self.definition, unit=0.0)
        self._shifts = Rounding(graph.probes.generic, self.definition, unit=0.0, shift=1.0)
        self._tolerances = Tolerances.for_model_error(
            model_error, self.rounding.most, self._levers.most, self._shifts.most
        )
        self.digits = FileDigits(self.g, self.definition, self._tolerances.fold)
        self.loses_digits = bool(graph.probes.kept) or any(map(self._folds, graph.steps))
        self.residuals: list[Expr] = []
        self.norms: list[Expr] = []
        self.close: list[Expr] = []
        self.folds: list[Expr] = []
        self.double_roots = DoubleRoots(self.g, self.definition)
        self.double: Expr | None = None
        self.levels = [LoweredLevel(1)]
        self.level_of: dict[int, int] = {}
        self.placed: set[int] = set()
        self.names: dict[int, str] = {}
        self.singular: list[Expr] = []
        self.hidden: list[Expr] = []
        self.lost: list[Expr] = []
        self.doubts: list[Expr] = []
        self.inputs: list[Input] = []
        self.prelude: list[Let] = []

    @property
    def rough(self) -> Expr | None:
        """Condition that an unknown solved so far has lost digits, where the Program `loses_digits`. With
        constants as the file rounds them a continuum's place is taken by solutions that few digits tell
        apart, and two of them meet where it would be; where branches of a step meet at a regular
        configuration, the next root is taken of what has half the digits. None where nothing of this can
        be."""
        return either(self.g, (*self.singular, *self.folds))

    def note_fold(self, under: Expr, size: float) -> None:
        """A square root was taken of `under`: of few digits where that is small beside `size`."""
        self.close.append(self.g.binary("gt", self.g.const(FOLDED * size), under))
        self.double_roots.note(self.close[-1])
        if self.loses_digits:
            self.folds.append(self.close[-1])
        if self._counts_digits:
            self.digits.note(self.g.mul(self.g.const(1.0 / size), under))

    def note_root(self, atoms: Sequence[Expr], equation: Expr, slope: Expr) -> None:
        """The atoms are the cosine and sine of a root, a double one where the slope vanishes."""
        self.rounding.note_root(atoms, equation, slope)
        folds = len(self.folds)
        self.note_fold(self.g.square(slope), natural_size(slope) ** 2)
        before = () if self.double is None else (self.double,)
        self.double = either(self.g, (*before, *self.folds[folds:]))
        if self._tolerances.fold:  # of the two that meet the routine gives one
            self.doubts.append(self.close[-1])
            self.place(self.doubts[-1])
        self._settle(atoms, (equation,))

    def note_divisors(self, divisors: Sequence[Divisor]) -> None:
        """An unknown was divided by the first of these that is large: its direction is lost where that is
        small beside what the unknowns before leave of the file's digits."""
        squares = [one.square(self.g) for one in divisors] if self._counts_digits else []
        if squares and None not in squares:
            largest = reduce(partial(self.g.binary, "max"), filter(None, squares))
            before = self.digits.behind(*(one.value for one in divisors))
            if before is not None and self._tolerances.fold:
                least = self.g.const(self._tolerances.norm**2)
                left = self.g.mul(largest, self.digits.no_less(before))
                self.lost.append(self.g.binary("gt", least, left))
                if any(one.power == 2 for one in divisors):
                    # as little: the continuum that it vanishes on may go on in the file's geometry
                    few = self.g.const(self.model_error**2)
                    self.doubts.append(self.g.binary("gt", few, left))
                    self.place(self.doubts[-1])
            self.digits.note(largest)

    @property
    def _counts_digits(self) -> bool:
        """Whether it matters by how much one unknown after the other is off: by the geometry, or by what it
        loses of round-off."""
        return bool(self._tolerances.fold) or self.loses_digits

    @property
    def tolerances(self) -> Tolerances:
        """Tolerances of the next unknown."""
        double = None if self._tolerances.fold else self.double
        margin = self.digits.behind
        tolerances = replace(self._tolerances, margin=margin, double=double)
        if self.loses_digits:
            return replace(tolerances, rough=self.rough)
        return replace(tolerances, folded=self.double_roots.behind)

    @property
    def whole_pose(self) -> bool:
        """Whether every entry of the pose is read; then any split compares it."""
        return self.system.readable == WHOLE_POSE

    def atom(self, name: str, probe: NDArray[np.float64] | None = None) -> Expr:
        """An atom of a name that is given; `probe` are its values at the probes."""
        values = np.zeros(self.g.probes) if probe is None else probe
        node = self.g.atom("input", name, values, unknown=False)
        self.names[node.id] = name
        return node

    def level(self, node: Expr) -> int:
        """Innermost level that the expression depends on."""
        found = self.level_of.get(node.id)
        if found is not None:
            return found
        if node.id in self.definition:
            found = self.level(self.definition[node.id])
        else:
            found = max((self.level(a) for a in node.args), default=0)
        self.level_of[node.id] = found
        return found

    def canonical(self, node: Expr) -> Expr:
        """The node, or what an atom without a name of its own stands for."""
        while node.id in self.definition and node.id not in self.names:
            node = self.definition[node.id]
        return node

    def defined(self, node: Expr) -> Expr:
        """The node, or the definition of a solved atom."""
        while node.id in self.definition:
            node = self.definition[node.id]
        return node

    def place(self, item: Expr | Comment) -> None:
        """Schedule an expression and what it needs."""
        if isinstance(item, Comment):
            self.levels[-1].items.append(item)
            return
        if item.id in self.placed:
            return
        self.placed.add(item.id)
        if item.id in self.definition:
            self.place(self.definition[item.id])
        for a in item.args:
            self.place(a)
        if item.args or item.id in self.definition:
            self.levels[self.level(item)].items.append(item)

    def slope(self, v: Variable, form: Form) -> Expr | None:
        """What vanishes where the root of a routine's form is a double one."""
        return form.slope(self.g, self.atoms_of(v)) if v.kind == "angle" else None

    def _folds(self, step: Step) -> bool:
        """Whether branches of a step meet at a regular configuration, or next to one."""
        forms = (step.candidate, *step.fallbacks)
        judged = [c.judgement for c in forms if c.judgement is not None]
        if any(one.folds or one.steepness < _CROWDED for one in judged):
            return True
        slopes = [self.slope(c.unknown, c.form) for c in forms]
        seen = slice(self.probes.regular)
        return any(
            bool((np.abs(e.probe[seen]) < FOLDED * natural_size(e)).any()) for e in slopes if e
        )

    def require(self, condition: Expr, *, fold: bool = False) -> None:
        """Schedule a guard."""
        self.place(condition)
        self.levels[self.level(condition)].items.append(Requirement(condition, fold))

    def require_solution(self, condition: Expr, *, fold: bool = False) -> None:
        """Schedule a guard of what an unknown is; where a direction is lost it tells nothing."""
        known = self.level(condition)
        nothing = either(self.g, (one for one in self.lost if self.level(one) <= known))
        if nothing is not None:
            self.hidden.append(self.g.binary("and", nothing, self.g.unary("not", condition)))
            self.place(self.hidden[-1])
        self.require(condition, fold=fold)

    def define(self, v: Variable, values: tuple[Expr, ...]) -> None:
        """Give a solved variable its cosine and sine, or its distance."""
        atoms = self.atoms_of(v)
        letters = "cs" if v.kind == "angle" else "d"
        names = [f"{x}{v.index}" for x in letters]
        for atom, name, value in zip(atoms, names, values, strict=True):
            self.definition[atom.id] = value
            self.names[atom.id] = local_name(name)
            self.place(atom)
        self._levers.note_moved(atoms)
        self._shifts.note_exact(atoms)
        self._settle(atoms, values)

    def _settle(self, atoms: Sequence[Expr], values: Sequence[Expr]) -> None:
        """The unknown of these atoms is solved, from these values."""
        self.double_roots.settle(atoms)
        self.digits.settle(atoms, values)

    def atoms_of(self, v: Variable) -> tuple[Expr, ...]:
        """The atoms of a variable: its cosine and sine, or its distance."""
        if v.kind == "angle":
            return self.knowledge.variables.pair(v.combination)
        assert v.joint is not None
        return (self.knowledge.variables.distance(v.joint),)

    def price(self, roots: list[Expr]) -> float:
        """Operations that the roots need beyond what is placed, each as often as it has branches."""
        counts = [1.0]
        for level in self.levels[1:]:
            counts.append(counts[-1] * level.branches)
        total = 0.0
        for node in dependencies(roots, self.definition, self.placed):
            if node.args and not node.is_fixed and node.id not in self.placed:
                total += counts[self.level(node)]
        return total


def local_name(name: str) -> str:
    """The name of a value in a Program: what no language takes is an underscore."""
    return "".join(ch if ch.isalnum() else "_" for ch in name)
