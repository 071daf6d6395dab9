"""How far round-off moves values: running error analysis at the probes.

Each operation adds half a unit in the last place of its result to what its arguments are off (Wilkinson
1963; Higham, *Accuracy and Stability of Numerical Algorithms*, 3.3), at random configurations. A small
divisor, a slender lever or a nearly double root enlarges it, and what follows from the result feels it.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ikgen.algebra.expression import Expr, Probe

__all__ = ["Rounding"]

_UNIT = float(np.finfo(float).eps)
_EXACT = frozenset({"const", "param", "gt", "and", "or", "not"})


class Rounding:
    """Bounds on errors of expressions at the first `count` probes; `definition`: what solved atoms stand
    for. `unit`: what an operation rounds by, relative to its result; `shift`: how far the entries of the
    pose are off (m or 1)."""

    def __init__(
        self, count: int, definition: dict[int, Expr], unit: float = _UNIT, shift: float = 0.0
    ) -> None:
        self._count = count
        self._definition = definition
        self._unit = unit
        self._shift = shift
        self._known: dict[int, Probe] = {}

    def note_root(self, atoms: Sequence[Expr], equation: Expr, slope: Expr) -> None:
        """The atoms are the cosine and sine of a root: off by what the equation is, over its slope."""
        here = Rounding(self._count, self._definition, self._unit)
        here._known = self._known | {a.id: np.zeros(self._count) for a in atoms}
        with np.errstate(all="ignore"):
            off = here.of(equation) / np.abs(self._at(slope))
        self._known |= {a.id: off for a in atoms}

    def note_moved(self, atoms: Sequence[Expr]) -> None:
        """The atoms, a cosine and a sine or a distance, are those of an angle that is off by a radian, to
        first order, or a distance that is by a metre."""
        turns = [np.abs(self._at(a)) for a in reversed(atoms)]
        off = turns if len(atoms) == 2 else [np.ones(self._count)]
        self._known |= {a.id: x for a, x in zip(atoms, off, strict=True)}

    def note_exact(self, atoms: Sequence[Expr]) -> None:
        """The atoms are what they are."""
        self._known |= {a.id: np.zeros(self._count) for a in atoms}

    def of(self, e: Expr) -> Probe:
        """What an expression is off (count,)."""
        stack = [e]
        while stack:
            node = stack[-1]
            behind = self._behind(node)
            missing = [a for a in behind if a.id not in self._known]
            if missing:
                stack += missing
                continue
            stack.pop()
            if node.id not in self._known:
                with np.errstate(all="ignore"):
                    self._known[node.id] = self._error(node, [self._known[a.id] for a in behind])
        return self._known[e.id]

    def most(self, e: Expr) -> float:
        """What an expression is off at most."""
        return float(np.nan_to_num(self.of(e), nan=np.inf).max())

    def _behind(self, node: Expr) -> tuple[Expr, ...]:
        if node.id in self._known or self._shifted(node):
            return ()
        return (self._definition[node.id],) if node.id in self._definition else node.args

    def _at(self, e: Expr) -> Probe:
        return e.probe[: self._count]

    def _shifted(self, node: Expr) -> bool:
        return self._shift > 0.0 and node.atom is not None and node.atom.kind == "pose"

    def _error(self, node: Expr, errors: list[Probe]) -> Probe:
        if self._shifted(node):
            return np.full(self._count, self._shift)
        if node.id in self._definition:
            return errors[0]
        value = self._at(node)
        if node.op in _EXACT:
            return np.zeros(self._count)
        if not errors:  # an entry of the pose
            return np.full(self._count, self._unit * np.abs(node.probe).max(initial=0.0))
        return np.asarray(self._moved(node, errors) + 0.5 * self._unit * np.abs(value))

    def _moved(self, node: Expr, errors: list[Probe]) -> Probe:
        """What an operation makes of its arguments' errors."""
        x = [self._at(a) for a in node.args]
        if node.op == "mul":
            return np.asarray(errors[0] * np.abs(x[1]) + errors[1] * np.abs(x[0]))
        if node.op == "div":
            return np.asarray((errors[0] + np.abs(x[0] / x[1]) * errors[1]) / np.abs(x[1]))
        if node.op == "sqrt":
            return np.asarray(np.minimum(errors[0] / (2.0 * np.sqrt(x[0])), np.sqrt(errors[0])))
        if node.op == "select":
            return np.where(x[0] > 0.5, errors[1], errors[2])
        if node.op in ("max", "min"):
            return np.maximum(*errors)
        return np.asarray(sum(errors))
