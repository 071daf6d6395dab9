"""Lower a solution graph to a Program: one lowering for every language."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ikgen.equations.expression import Expr, ExpressionGraph
from ikgen.equations.knowledge import Variable
from ikgen.equations.probes import arm_size
from ikgen.equations.rigid import Rigid, constant, inverse, multiply
from ikgen.ir.forms import Realized, realize
from ikgen.ir.ops import BOOLEAN, Op, Operand
from ikgen.ir.program import (
    Call,
    Comment,
    JointOutput,
    Let,
    Level,
    Program,
    Require,
    Statement,
)
from ikgen.solver.graph import SolutionGraph
from ikgen.solver.session import Step

__all__ = ["lower"]

CHECK_TOLERANCE = 5e-10
"""Largest error (m over the arm's size, rad) of a row that counts as a solution."""


@dataclass
class _Level:
    branches: int
    sigma: Expr | None
    call: tuple[str, tuple[Expr, ...], tuple[Expr, ...]] | None
    items: list[Expr | Comment | tuple[str, Expr]] = field(default_factory=list)


class _Lowering:
    """Places every needed expression at the outermost level that its dependencies allow."""

    def __init__(self, graph: SolutionGraph, slack: float) -> None:
        self.solution = graph
        self.session = graph.session
        self.system = graph.session.system
        self.dh = self.system.dh
        self.g: ExpressionGraph = self.system.graph
        self.knowledge = graph.knowledge
        self.slack = slack
        self.levels = [_Level(1, None, None)]
        self.definition: dict[int, Expr] = dict(self.knowledge.binding)
        self.level_of: dict[int, int] = {}
        self.placed: set[int] = set()
        self.names: dict[int, str] = {}
        self.singular: list[Expr] = []
        self.inputs: list[str] = []

    # -- inputs ---------------------------------------------------------------------------------

    def _input(self, name: str, probe: np.ndarray | None = None) -> Expr:
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
        raw = self.dh.X_base @ pose @ self.dh.X_tip
        rows = tuple(
            tuple(self._input(f"t{i}{j}", raw[:, i, j]) for j in range(3)) for i in range(3)
        )
        p = tuple(self._input(f"t{i}3", raw[:, i, 3]) for i in range(3))
        T: Rigid = multiply(g, inverse(g, base), Rigid(rows, p))
        if self.system.tool.p == (g.zero,) * 3:
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

    def resolve(self, node: Expr) -> Expr:
        """The node, or what an atom stands for."""
        while node.id in self.definition and node.id not in self.names:
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
        if item.args or item.id in self.names:
            self.levels[self.level(item)].items.append(item)

    def require(self, condition: Expr) -> None:
        """Schedule a guard."""
        self.place(condition)
        self.levels[self.level(condition)].items.append(("require", condition))

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
            self.levels.append(_Level(2, sigma, None))
            self.level_of[sigma.id] = len(self.levels) - 1
            self.names[sigma.id] = f"sigma_{v.text.split('_', 1)[-1]}"
        else:
            sigma = g.one
        self.place(Comment(text))
        forms = [realize(g, c, sigma, self.slack) for c in (step.candidate, *step.fallbacks)]
        self._define(v, self._select(v, forms, sigma))

    def _select(self, v: Variable, forms: list[Realized], sigma: Expr) -> tuple[Expr, ...]:
        """The first form whose divisor does not vanish; the seed's value if there is none."""
        g = self.g
        for i, form in enumerate(forms[:-1]):
            forms[i] = self._well_conditioned(form)
        values: tuple[Expr, ...] | None = None
        if forms[-1].regular is not None:
            values = self.seed_values(v)
        single: Expr | None = None
        guard: Expr | None = None
        free: Expr | None = None
        for form in reversed(forms):
            here = form.regular
            values = form.values if here is None or values is None else tuple(
                g.select(here, a, b) for a, b in zip(form.values, values, strict=True)
            )
            guard = _choose(g, here, form.guard, guard)
            single = _choose_flag(g, here, form.branches == 1, single)
            free = _choose_flag(g, here, False, free, last=True)
        if guard is not None:
            self.require(guard)
        if sigma is not g.one and single is not None:
            self.require(g.binary("or", g.unary("not", single), g.binary("gt", sigma, g.zero)))
        if free is not None:
            self.place(free)
            self.singular.append(free)
        assert values is not None
        return values

    def _well_conditioned(self, form: Realized) -> Realized:
        """With a fallback behind it a form is left well before its divisor vanishes."""
        regular = form.regular
        if regular is None:
            return form
        limit = self.g.const(regular.args[1].value / 1e-11 * 1e-3)
        return Realized(
            form.values, self.g.binary("gt", regular.args[0], limit), form.guard, form.branches
        )

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

    def _quartic(self, index: int, step: Step, text: str) -> None:
        v = step.candidate.unknown
        for e in step.candidate.coefficients:
            self.place(e)
        atoms = self.knowledge.variables.pair(v.key)
        arguments = step.candidate.coefficients
        self.levels.append(_Level(4, None, ("trig_quartic", arguments, atoms)))
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
        g = self.g
        best: tuple[float, list[tuple[Expr, Expr]]] | None = None
        n = self.system.n
        for k in range(n):
            for m in range(k + 1, n + 1):
                pairs = self._residuals(k, m)
                cost = self._price([g.sub(a, b) for a, b in pairs])
                if best is None or cost < best[0]:
                    best = (cost, pairs)
        assert best is not None
        size = max(arm_size(self.dh), 1e-9)
        rotation = g.zero
        position = g.zero
        for i, (a, b) in enumerate(best[1]):
            d = g.square(g.sub(a, b))
            if i < 3:
                position = g.add(position, d)
            else:
                rotation = g.add(rotation, d)
        limit = max(CHECK_TOLERANCE, 30 * self.slack)
        self.place(Comment("does the row reproduce the pose?"))
        self.require(g.binary("gt", g.const((limit * max(size, 1.0)) ** 2), position))
        if rotation is not g.zero:
            self.require(g.binary("gt", g.const(limit**2), rotation))

    def _residuals(self, k: int, m: int) -> list[tuple[Expr, Expr]]:
        left, right = self.system.left(k, m), self.system.right(k, m)
        readable = self.knowledge.known_expr
        pairs = [(left.p[i], right.p[i]) for i in range(3)]
        pairs += [(left.R[i][j], right.R[i][j]) for i in range(3) for j in range(3)]
        return [(a, b) for a, b in pairs if readable(a)]

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


def _choose(
    g: ExpressionGraph, here: Expr | None, mine: Expr | None, other: Expr | None
) -> Expr | None:
    """Guard of alternatives: mine where `here` holds, else the other's."""
    if here is None:
        return mine
    mine_ok = mine if mine is not None else None
    first = g.binary("or", g.unary("not", here), mine_ok) if mine_ok is not None else None
    second = g.binary("or", here, other) if other is not None else None
    if first is None or second is None:
        return first if second is None else second
    return g.binary("and", first, second)


def _choose_flag(
    g: ExpressionGraph, here: Expr | None, mine: bool, other: Expr | None, *, last: bool = False
) -> Expr | None:
    """A flag that is `mine` where `here` holds, else the other's (true at the very end)."""
    del last
    if here is None:
        return g.one if mine else None
    missing = g.unary("not", here)
    rest = missing if other is None else (missing if other is g.one else g.binary("and", missing, other))
    if mine:
        return g.one if rest is None else g.binary("or", here, rest)
    return rest
