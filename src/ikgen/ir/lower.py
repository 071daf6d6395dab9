"""Lower a solution graph to a Program: one lowering for every language."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ikgen.equations.build import ENTRY_NAMES
from ikgen.equations.expression import Expr, ExpressionGraph
from ikgen.equations.knowledge import Variable
from ikgen.equations.probes import arm_size
from ikgen.equations.rigid import Rigid, constant, inverse, multiply
from ikgen.ir.forms import ROUNDED, Divisor, Realized, Tolerances, realize
from ikgen.ir.program import Comment, Program
from ikgen.ir.serialize import LoweredLevel, Requirement, serialize
from ikgen.solver.graph import SolutionGraph
from ikgen.solver.session import Step

__all__ = ["lower"]

WELL_CONDITIONED = 1e-3
"""Relative size of a divisor below which a fallback is taken in its form's place."""

CHECK_TOLERANCE = 1e-6
"""Largest error (m over the arm's size, rad) of a row that may become a solution: near singularities
the closed form loses digits, which Newton steps win back."""


class Lowering:
    """Places every needed expression at the outermost level that its dependencies allow."""

    def __init__(self, graph: SolutionGraph, slack: float) -> None:
        self.solution = graph
        self.session = graph.session
        self.system = graph.session.system
        self.dh = self.system.dh
        self.g: ExpressionGraph = self.system.graph
        self.knowledge = graph.knowledge
        self.slack = slack
        self.tolerances = Tolerances.for_slack(slack)
        self.well = min(max(WELL_CONDITIONED, 10.0 * slack**0.5), 0.1)
        self.residuals: list[Expr] = []
        self.norms: list[Expr] = []
        self.levels = [LoweredLevel(1)]
        self.definition: dict[int, Expr] = dict(self.knowledge.binding)
        self.level_of: dict[int, int] = {}
        self.placed: set[int] = set()
        self.names: dict[int, str] = {}
        self.singular: list[Expr] = []
        self.inputs: list[str] = []

    @property
    def whole_pose(self) -> bool:
        """Whether every entry of the pose is read; then any split compares it."""
        return self.system.readable == frozenset(ENTRY_NAMES)

    # -- inputs ---------------------------------------------------------------------------------

    def _input(self, name: str, probe: NDArray[np.float64] | None = None) -> Expr:
        values = np.zeros(self.g.probes) if probe is None else probe
        node = self.g.atom("input", name, values, unknown=False)
        self.names[node.id] = name
        if name not in self.inputs:
            self.inputs.append(name)
        return node

    def bind_pose(self) -> None:
        """The pose in DH frames out of the given one: `X_base^-1 T X_tip^-1`."""
        g = self.g
        base, tip = constant(g, self.dh.X_base), constant(g, self.dh.X_tip)
        pose = self.session.probes.pose
        raw = self.dh.X_base @ pose
        if self.whole_pose:
            raw = raw @ self.dh.X_tip
        rows = tuple(
            tuple(self._input(f"t{i}{j}", raw[:, i, j]) for j in range(3)) for i in range(3)
        )
        p = tuple(self._input(f"t{i}3", raw[:, i, 3]) for i in range(3))
        T: Rigid = multiply(g, inverse(g, base), Rigid(rows, p))
        if self.whole_pose:
            T = multiply(g, T, inverse(g, tip))
        target = self.system.pose
        self.place(Comment("the pose in DH frames"))
        for i in range(3):
            for j in range(3):
                self.definition[target.R[i][j].id] = T.R[i][j]
            self.definition[target.p[i].id] = T.p[i]

    def bind_seeds(self) -> None:
        """Values that joints take where a pose leaves them free, and those of held joints."""
        for j in range(self.dh.dof):
            if self.session.joint_variable(j).kind == "angle":
                self._input(f"seed_c{j + 1}")
                self._input(f"seed_s{j + 1}")
            else:
                self._input(f"seed_d{j + 1}")
        for j in self.session.held:
            v = self.session.joint_variable(j)
            if v.kind == "angle":
                c, s = self.knowledge.variables.pair(v.key)
                self.names[c.id], self.names[s.id] = f"c{j + 1}", f"s{j + 1}"
                self.inputs += [f"c{j + 1}", f"s{j + 1}"]
            else:
                d = self.knowledge.variables.distance(j)
                self.names[d.id] = f"d{j + 1}"
                self.inputs.append(f"d{j + 1}")

    def seed_values(self, variable: Variable) -> tuple[Expr, ...]:
        """The seed's value of a variable: sums of joint angles are composed."""
        g = self.g
        if variable.kind == "dist":
            assert variable.joint is not None
            return (self._input(f"seed_d{variable.joint + 1}"),)
        c, s = g.one, g.zero
        for j, k in enumerate(variable.key):
            cj, sj = (self._input(f"seed_{x}{j + 1}") for x in "cs") if k else (g.one, g.zero)
            for _ in range(abs(k)):
                sj_signed = sj if k > 0 else g.neg(sj)
                c, s = (
                    g.sub(g.mul(c, cj), g.mul(s, sj_signed)),
                    g.add(g.mul(s, cj), g.mul(c, sj_signed)),
                )
        return c, s

    # -- placement ------------------------------------------------------------------------------

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

    def require(self, condition: Expr) -> None:
        """Schedule a guard."""
        self.place(condition)
        self.levels[self.level(condition)].items.append(Requirement(condition))

    # -- steps ----------------------------------------------------------------------------------

    def step(self, index: int, step: Step) -> None:
        """One solved unknown."""
        g = self.g
        v = step.candidate.unknown
        text = f"{v.text}: {step.candidate.leaf}, from {_labels(step)}"
        if step.candidate.form == "quartic":
            self._quartic(index, step, text)
            return
        if step.branches > 1:
            sigma = g.atom("sigma", str(index), np.ones(g.probes), unknown=False)
            self.levels.append(LoweredLevel(2, sigma))
            self.level_of[sigma.id] = len(self.levels) - 1
            self.names[sigma.id] = f"sigma_{v.text.split('_', 1)[-1]}"
        else:
            sigma = g.one
        self.place(Comment(text))
        forms = [realize(g, c, sigma, self.tolerances) for c in (step.candidate, *step.fallbacks)]
        self._define(v, self._select(v, forms, sigma))
        if any(c.form == "pair" for c in (step.candidate, *step.fallbacks)):
            self._unit_norm(v)

    def _select(self, v: Variable, forms: list[Realized], sigma: Expr) -> tuple[Expr, ...]:
        """The first form whose divisor does not vanish; the seed's value if there is none.

        Where Newton steps follow, a small divisor gives but a rough value: all are tried for a large
        one first.
        """
        g = self.g
        first = [*map(self._well_conditioned, forms[:-1])]
        last = forms[-1].divisor
        if first and last.clear is not None and self.slack > ROUNDED:
            wide = Divisor(last.value, last.clear, last.clear)
            forms = [*first, replace(forms[-1], divisor=wide), *forms]
        else:
            forms = [*first, forms[-1]]
        values = self.seed_values(v) if forms[-1].regular is not None else forms[-1].values
        guard: Flag = True
        single: Flag = True
        free: Flag = True
        for form in reversed(forms):
            here = form.regular
            guard = pick(g, here, True if form.guard is None else form.guard, guard)
            single = pick(g, here, form.branches == 1, single)
            clear = form.divisor.clear
            free = pick(g, here, False if clear is None else g.unary("not", clear), free)
            if here is not None:
                both = zip(form.values, values, strict=True)
                values = tuple(g.select(here, mine, other) for mine, other in both)
            else:
                values = form.values
        if isinstance(guard, Expr):
            self.require(guard)
        if isinstance(single, Expr) and sigma is not g.one:
            self.require(g.binary("or", g.unary("not", single), g.binary("gt", sigma, g.zero)))
        if isinstance(free, Expr):
            self.place(free)
            self.singular.append(free)
        return values

    def _well_conditioned(self, form: Realized) -> Realized:
        """With a fallback behind it a form is left well before its divisor vanishes or its branches
        meet."""
        g, regular = self.g, form.regular
        good: Flag = True
        if regular is not None:
            power = 2 if form.branches == 2 else 1
            natural = regular.args[1].value / self.tolerances.singular**power
            limit = g.const(natural * self.well**power)
            good = g.binary("gt", regular.args[0], limit)
        if form.under is not None:
            limit = g.mul(g.const(self.well**2), form.under[1])
            apart = g.binary("gt", form.under[0], limit)
            good = apart if good is True else g.binary("and", _expr(good), apart)
        if good is True:
            return form
        divisor = Divisor(form.divisor.value, _expr(good), _expr(good))
        return Realized(form.values, divisor, form.guard, form.branches)

    def _define(self, v: Variable, values: tuple[Expr, ...]) -> None:
        variables = self.knowledge.variables
        if v.kind == "angle":
            atoms: tuple[Expr, ...] = variables.pair(v.key)
            names = tuple(f"{x}{v.text.split('_', 1)[1]}" for x in "cs")
        else:
            assert v.joint is not None
            atoms = (variables.distance(v.joint),)
            names = (f"d{v.joint + 1}",)
        for atom, name, value in zip(atoms, names, values, strict=True):
            self.definition[atom.id] = value
            self.names[atom.id] = _identifier(name)
            self.place(atom)

    def _unit_norm(self, v: Variable) -> None:
        """Two linear equations give a cosine and sine on the unit circle only if they agree with the
        rest: a branch whose squares do not add up to one is none."""
        g = self.g
        c, s = self.knowledge.variables.pair(v.key)
        excess = g.sub(g.add(g.square(c), g.square(s)), g.one)
        self.norms.append(excess)

    def _quartic(self, index: int, step: Step, text: str) -> None:
        v = step.candidate.unknown
        for e in step.candidate.coefficients:
            self.place(e)
        atoms = self.knowledge.variables.pair(v.key)
        arguments = step.candidate.coefficients
        self.levels.append(LoweredLevel(4, None, ("trig_quartic", arguments, atoms)))
        self.place(Comment(text))
        suffix = v.text.split("_", 1)[1]
        for atom, x in zip(atoms, "cs", strict=True):
            self.names[atom.id] = _identifier(f"{x}{suffix}")
            self.level_of[atom.id] = len(self.levels) - 1
            self.placed.add(atom.id)

    # -- the end --------------------------------------------------------------------------------

    def outputs(self) -> list[tuple[int, tuple[Expr, ...]]]:
        """Every joint's pair or distance."""
        out: list[tuple[int, tuple[Expr, ...]]] = []
        self.place(Comment("joint variables"))
        for j in range(self.dh.dof):
            v = self.session.joint_variable(j)
            if v.kind == "angle":
                values: tuple[Expr, ...] | None = self.knowledge.known_pair(v.key)
                assert values is not None
            else:
                values = (self.knowledge.variables.distance(j),)
            for e in values:
                self.place(e)
            out.append((j, values))
        return out

    def check(self) -> None:
        """A row is returned only if it reproduces the pose: the cheapest split is compared."""
        n = self.system.n
        splits = [(0, n)]
        if self.whole_pose:
            splits = [(k, m) for k in range(n) for m in range(k + 1, n + 1)]
        residuals = min((self._residuals(k, m) for k, m in splits), key=self._cost)
        self.place(Comment("does the row reproduce the pose?"))
        limit = max(CHECK_TOLERANCE, min(1000 * self.slack, 0.2))
        size = max(arm_size(self.dh), 1.0)
        for level in range(len(self.levels)):
            norms = [e for e in self.norms if self.level(e) == level]
            self._bounded(norms, limit)
        for parts, tolerance in zip(residuals, (limit * size, limit), strict=True):
            self._bounded(parts, tolerance)

    def _bounded(self, parts: list[Expr], tolerance: float) -> None:
        if parts:
            total = self.g.dot(parts, parts)
            self.require(self.g.binary("gt", self.g.const(tolerance**2), total))
            self.residuals.append(total)

    def _residuals(self, k: int, m: int) -> tuple[list[Expr], list[Expr]]:
        """Differences of position and of rotation of one split, those that vanish by construction
        and those that the task does not read left out."""
        left, right = self.system.left(k, m), self.system.right(k, m)
        position = list(zip(left.p, right.p, strict=True))
        rotation = [(left.R[i][j], right.R[i][j]) for i in range(3) for j in range(3)]
        return self._differences(position), self._differences(rotation)

    def _differences(self, pairs: list[tuple[Expr, Expr]]) -> list[Expr]:
        g = self.g
        out: list[Expr] = []
        for a, b in pairs:
            if not self.knowledge.known_expr(a) or not self.knowledge.known_expr(b):
                continue
            if g.sub(self.defined(a), self.defined(b)) is not g.zero:
                out.append(g.sub(a, b))
        return out

    def _cost(self, residuals: tuple[list[Expr], list[Expr]]) -> float:
        return self._price([*residuals[0], *residuals[1]])

    def _price(self, roots: list[Expr]) -> float:
        counts = [1.0]
        for level in self.levels[1:]:
            counts.append(counts[-1] * level.branches)
        seen: set[int] = set()
        total = 0.0
        stack = list(roots)
        while stack:
            node = stack.pop()
            if node.id in seen or node.id in self.placed:
                continue
            seen.add(node.id)
            if node.id in self.definition:
                stack.append(self.definition[node.id])
            elif node.args and not node.is_fixed:
                total += counts[self.level(node)]
            stack.extend(node.args)
        return total


def _labels(step: Step) -> str:
    return " and ".join(dict.fromkeys(e.label for e in step.candidate.sources))


def _identifier(name: str) -> str:
    return "".join(ch if ch.isalnum() else "_" for ch in name)


Flag = bool | Expr


def pick(g: ExpressionGraph, here: Expr | None, mine: Flag, other: Flag) -> Flag:
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


def lower(graph: SolutionGraph, *, slack: float = 0.0) -> Program:
    """The Program of a solution graph.

    `slack` is how far (m or rad) the file's geometry is off the exact one that was solved: square roots
    and the final check give way by that much, and Newton steps on the file's chain follow.
    """
    work = Lowering(graph, slack)
    work.bind_pose()
    work.bind_seeds()
    for index, step in enumerate(graph.steps):
        work.step(index, step)
    outputs = work.outputs()
    work.check()
    return serialize(work, outputs)
