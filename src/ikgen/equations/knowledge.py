"""What is known so far, and equations as polynomials in what is not.

An angle combination is known when it is an integer combination of solved ones: the lattice of the
known ones of its group. Unknown ones are written modulo that lattice on one representative each, so that
`cos(theta_23)` with theta_3 known is linear in the cosine and sine of theta_2.
"""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass

import numpy as np

from ikgen.algebra import polynomial as poly
from ikgen.algebra.expression import Expr
from ikgen.algebra.polynomial import AngleCombination, Monomial, Polynomial, canonical
from ikgen.equations.angle_lattice import AngleLattice
from ikgen.equations.equation import Equation
from ikgen.equations.equation_set import EquationSet

__all__ = ["UNREADABLE", "Knowledge", "PolynomialEquation", "Variable"]

UNREADABLE = 99
"""In place of a number of unknowns: more than any equation is looked at with."""


@dataclass(frozen=True, slots=True, order=True)
class Variable:
    """An unknown: the angle of a combination, or the prismatic variable of a joint (kind "prismatic")."""

    kind: str
    combination: AngleCombination

    @property
    def joint(self) -> int | None:
        """The joint whose own variable this is, if it is one."""
        ones = [j for j, k in enumerate(self.combination) if k]
        return ones[0] if len(ones) == 1 and self.combination[ones[0]] == 1 else None

    @property
    def text(self) -> str:
        """Name such as theta_23 or d_4."""
        letter = "theta" if self.kind == "angle" else "d"
        if all(k in (0, 1) for k in self.combination):
            return f"{letter}_" + "".join(str(j + 1) for j, k in enumerate(self.combination) if k)
        parts = [f"{k:+d}*{letter}_{j + 1}" for j, k in enumerate(self.combination) if k]
        return "(" + "".join(parts) + ")"

    @property
    def index(self) -> str:
        """What names in emitted code end in, such as 23, 4, or 2_minus_3 of a difference."""
        if all(k in (0, 1) for k in self.combination):
            return self.text.split("_", 1)[1]
        signs = {True: "", False: "minus_"}
        parts = [
            f"{signs[k > 0]}{f'{abs(k)}x' if abs(k) > 1 else ''}{j + 1}"
            for j, k in enumerate(self.combination)
            if k
        ]
        return "_".join(parts)


@dataclass(frozen=True, slots=True)
class PolynomialEquation:
    """`polynomial = 0` in the unknowns, made from the named matrix equations."""

    polynomial: Polynomial
    unknowns: tuple[Variable, ...]
    sources: tuple[Equation, ...]
    rank: int

    @property
    def squared(self) -> bool:
        """Whether a sum of squares went into it."""
        return any(e.squared for e in self.sources)


class Knowledge:
    """Known atoms and their definitions; grows as variables are solved."""

    def __init__(self, equations: EquationSet) -> None:
        self.equations = equations
        self.graph = equations.graph
        self.variables = equations.variables
        self.known_mask = 0
        self.binding: dict[int, Expr] = {}
        self._lattice = AngleLattice(equations.graph, equations.variables)
        self._converted: dict[int, tuple[int, Polynomial]] = {}
        self._ranks: dict[int, int] = {}
        self._rewritten: dict[tuple[AngleCombination, str], Polynomial] = {}

    def workspace(self) -> Knowledge:
        """What is known, over an expression graph of its own: what is added there is not seen here."""
        other = copy(self)
        other.graph = self.graph.extended()
        other.equations = self.equations.over(other.graph)
        other.variables = other.equations.variables
        other.binding, other._converted = dict(self.binding), {}
        other._ranks, other._rewritten = {}, {}
        other._lattice = self._lattice.over(other.graph, other.variables)
        return other

    def joint_variable(self, joint: int) -> Variable:
        """The variable of a joint."""
        revolute = self.variables.primary[joint].revolute
        return Variable("angle" if revolute else "prismatic", self.variables.unit(joint))

    # -- learning -------------------------------------------------------------------------------

    def learn_angle(self, combination: AngleCombination) -> None:
        """Mark a combination's cosine and sine as known."""
        self._lattice.add(combination)
        self.refresh()

    def learn_distance(self, joint: int) -> None:
        """Mark a prismatic variable as known."""
        self.known_mask |= self.variables.distance(joint).support
        self.refresh()

    def refresh(self) -> None:
        """Rebuild the lattice of known combinations and mark the atoms in it."""
        self._lattice.rebuild()
        self._ranks.clear()
        self._rewritten.clear()
        self._mark_atoms()

    def _mark_atoms(self) -> None:
        """Every atom whose combination has become known gets its definition, once."""
        known = self._lattice.known
        pending: set[AngleCombination] = set()
        for unknown in self.graph.atoms_in(self.graph.unknown_mask & ~self.known_mask):
            atom = unknown.atom
            assert atom is not None
            if atom.kind in ("cos", "sin"):
                assert not isinstance(atom.key, str)
                pending.add(atom.key)
        for combination in sorted(filter(known.__contains__, pending), key=known.order):
            c = self.graph.find_atom("cos", combination)
            s = self.graph.find_atom("sin", combination)
            for node in (c, s):
                if node is not None and not node.support & self.known_mask:
                    self.known_mask |= node.support
                    if combination not in self._lattice.solved:
                        pair = self.known_pair(combination)
                        assert pair is not None
                        self.binding[node.id] = pair[0] if node is c else pair[1]

    def known_pair(self, combination: AngleCombination) -> tuple[Expr, Expr] | None:
        """Cosine and sine of a known combination's angle, composed from solved ones; None if unknown."""
        return self._lattice.pair(combination)

    def composition(
        self, combination: AngleCombination
    ) -> tuple[tuple[int, AngleCombination], ...]:
        """A known angle as integer combination of solved ones: (factor, solved combination) pairs."""
        return self._lattice.known[combination]

    def is_known(self, variable: Variable) -> bool:
        """Whether the variable is solved or follows from solved ones."""
        if variable.kind == "angle":
            return variable.combination in self._lattice.known
        joint = variable.joint
        assert joint is not None
        return bool(self.variables.distance(joint).support & self.known_mask)

    def leaves_parts(self, variable: Variable) -> bool:
        """Whether with the variable solved too a joint's angle would follow but for whole parts of a
        turn."""
        return variable.kind == "angle" and self._lattice.leaves_parts(variable.combination)

    def known_expr(self, node: Expr) -> bool:
        """Whether an expression has known atoms only."""
        return not node.support & ~self.known_mask

    # -- conversion -----------------------------------------------------------------------------

    def convert(self, node: Expr) -> Polynomial:
        """The node as a polynomial in the unknown atoms (combinations not yet reduced)."""
        unknown = node.support & ~self.known_mask
        if not unknown:
            return {} if node.vanishes else {poly.ONE: node}
        found = self._converted.get(node.id)
        if found is None or found[0] != unknown:
            found = self._converted[node.id] = unknown, self._convert(node)
        return found[1]

    def _convert(self, node: Expr) -> Polynomial:
        g = self.graph
        if node.atom is not None:
            return self._convert_atom(node)
        parts = [self.convert(a) for a in node.args]
        if node.op == "add":
            return poly.add(g, parts[0], parts[1])
        if node.op == "sub":
            return poly.subtract(g, parts[0], parts[1])
        if node.op == "neg":
            return poly.scale(g, parts[0], g.minus_one)
        if node.op == "mul":
            return poly.multiply(g, self.variables.group_of, parts[0], parts[1])
        raise AssertionError(f"operation {node.op} in an equation")

    def _convert_atom(self, node: Expr) -> Polynomial:
        g, atom = self.graph, node.atom
        assert atom is not None
        if atom.kind == "prismatic":
            assert not isinstance(atom.key, str)
            joint = atom.key.index(1)
            return {((), ((joint, 1),)): g.one}
        assert not isinstance(atom.key, str)
        return {(((atom.key, atom.kind[0]),), ()): g.one}

    def reduce(self, polynomial: Polynomial) -> Polynomial:
        """Rewrite every combination on its representative modulo the known lattice."""
        g = self.graph
        out: Polynomial = {}
        for (trigs, slides), value in polynomial.items():
            term: Polynomial = {((), slides): value}
            for trig in trigs:
                if trig not in self._rewritten:
                    self._rewritten[trig] = self._reduced(*trig)
                term = poly.multiply(g, self.variables.group_of, term, self._rewritten[trig])
            out = poly.add(g, out, term)
        return out

    def _reduced(self, combination: AngleCombination, kind: str) -> Polynomial:
        g = self.graph
        if combination in self._lattice.known:
            pair = self.known_pair(combination)
            assert pair is not None
            return {poly.ONE: pair[0] if kind == "c" else pair[1]}
        factor, rep, shift = self._lattice.represent(combination)
        target, sign = canonical(tuple(factor * r for r in rep))
        pair = self.known_pair(shift)
        assert pair is not None
        kc, ks = pair
        c: Monomial = (((target, "c"),), ())
        s: Monomial = (((target, "s"),), ())
        sine = g.const(float(sign))
        by_kind = {
            "c": {c: kc, s: g.neg(g.mul(sine, ks))},
            "s": {c: ks, s: g.mul(sine, kc)},
        }
        raw = by_kind[kind]
        return {m: v for m, v in raw.items() if v is not g.zero and not v.vanishes}

    # -- equations ------------------------------------------------------------------------------

    def unknown_rank(self, support: int) -> int:
        """Number of independent unknowns among the atoms of a support mask; `UNREADABLE` where an entry
        of the pose is among them that the task does not read."""
        mask = support & ~self.known_mask
        if mask not in self._ranks:
            self._ranks[mask] = self._rank_of(mask)
        return self._ranks[mask]

    def _rank_of(self, mask: int) -> int:
        combinations: list[AngleCombination] = []
        distances: set[AngleCombination] = set()
        for node in self.graph.atoms_in(mask):
            assert node.atom is not None
            if node.atom.kind == "pose":
                return UNREADABLE
            assert not isinstance(node.atom.key, str)
            if node.atom.kind == "prismatic":
                distances.add(node.atom.key)
            else:
                combinations.append(node.atom.key)
        return self._lattice.rank(combinations) + len(distances)

    def unknowns_of(self, polynomial: Polynomial) -> tuple[tuple[Variable, ...], int]:
        """Representatives in a reduced polynomial, and their rank."""
        angles: set[Variable] = set()
        distances: set[Variable] = set()
        for trigs, slides in polynomial:
            for combination, _ in trigs:
                divisor = int(np.gcd.reduce([abs(k) for k in combination]))
                angles.add(Variable("angle", tuple(k // divisor for k in combination)))
            for joint, _ in slides:
                distances.add(Variable("prismatic", self.variables.unit(joint)))
        rank = self._lattice.rank([v.combination for v in angles]) + len(distances)
        return tuple(sorted(angles | distances)), rank

    def polynomial_equation(self, equation: Equation) -> PolynomialEquation:
        """`right - left` of a matrix equation as a polynomial in the unknowns."""
        raw = poly.subtract(self.graph, self.convert(equation.right), self.convert(equation.left))
        reduced = self.reduce(raw)
        unknowns, rank = self.unknowns_of(reduced)
        return PolynomialEquation(reduced, unknowns, (equation,), rank)
