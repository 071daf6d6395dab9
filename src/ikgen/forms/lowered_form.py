"""A solution form over the expression graph: values, divisors and guards as expressions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph

__all__ = [
    "ROUNDED",
    "Divisor",
    "LoweredBranches",
    "LoweredForm",
    "LoweredRoutine",
    "Tolerances",
    "at_least",
    "divisor_of",
    "leading",
    "natural_size",
    "sign_of_squares",
]


ROUNDED = 2e-9
"""Model error (m or rad) above which every row is refined."""

_HALF_OF_DIGITS = 1e-8
"""What a double root has: its error leaves no direction of a smaller divisor."""

Bound = Callable[[Expr], float]
Margin = Callable[[Expr], Expr | None]

_MULTIPLIED = 12.0
"""Times the model error over a square root that what follows from it may be off: the file's offsets, over
links that are short beside the arm."""

_FURTHER = 3.0
"""Times as far as at random configurations, to first order, that what unknowns are off may move what
follows from them."""

_WORST = 10.0
"""Times as far as at random configurations that what the pose is off may move what is under a square root,
which counts where links are short beside the pose's lengths."""

_OUTSIDE = 0.5
"""How far outside its domain, of its natural size, what is under a square root may be at most: the branches
of one that is farther outside are near no solution."""

_BESIDE = 100.0
"""Times as far as at regular configurations that round-off may move what is under a square root, beside
singularities of what it follows from: rows that are none show by what they leave of the pose."""


def nothing_lost(value: Expr) -> float:
    """Default of `lost`, `moved` and `shifted`: the value is exact."""
    return 0.0 * value.scale


def no_margin(value: Expr) -> None:
    """Default of `folded` and `margin`: there is none."""


@dataclass(frozen=True, slots=True)
class Tolerances:
    """Relative to natural sizes: a divisor below `singular` makes its joint free, one below `flag`, or
    `norm` where it is a sum of squares, marks the solution as one of a continuum; a square root's
    argument may be `clamp` outside its domain, as poses on the boundary of the workspace are reachable, or
    `further` where it follows from unknowns; where rows are refined it is kept above `fold`, so that two
    branches start apart. Where the condition `rough` holds, what a square root is taken of has lost digits:
    it may be `wide` outside; so it may where `folded` gives a condition for what it is taken of, and that
    holds. An `error` of the geometry moves what follows from a square root by as much over that root, and
    what follows from a divisor by as much over it: `margin` gives what the unknowns that a value follows
    from leave of the file's digits, as a square relative to natural sizes (see `FileDigits`), and `moved`
    bounds how far a value goes for each radian, or metre, that the unknowns before it are off. `lost`
    bounds by how much round-off moves one, `shifted` how far one goes for each radian, or metre, that the
    entries of the pose are off; where `double` holds, an unknown solved so far is nearly a
    double root.
    """

    singular: float = 1e-11
    flag: float = 1e-4
    norm: float = 1e-4
    clamp: float = 1e-11
    further: float = 1e-11
    fold: float = 0.0
    rough: Expr | None = None
    wide: float = 1e-3
    error: float = 0.0
    folded: Margin = no_margin
    margin: Margin = no_margin
    lost: Bound = nothing_lost
    moved: Bound = nothing_lost
    shifted: Bound = nothing_lost
    double: Expr | None = None

    @staticmethod
    def for_model_error(
        error: float,
        lost: Bound = nothing_lost,
        moved: Bound = nothing_lost,
        shifted: Bound = nothing_lost,
    ) -> Tolerances:
        """Tolerances where the solved geometry is `error` (m or rad) off the file's.

        Where rows are not refined, a divisor that is no larger than what the two differ by is as good as
        zero: the file's direction of it is lost. Of length `x` it turns by `error / x`: where rows are
        refined, a fiftieth of a radian is too far to start from. Where they are not, the least divisor that
        is no singularity moves what a square root is taken of by as much: what is no solution beyond the
        workspace's boundary then shows by what it leaves of the pose.
        """
        fold = 0.05 * error if error > ROUNDED else 0.0
        singular = 1e-11 if error > ROUNDED else max(1e-11, 4.0 * error)
        flag, norm = (min(max(1e-4, share * error), 1e-2) for share in (5.0, 50.0))
        clamp = max(1e-11, 25.0 * error)
        further = clamp if error > ROUNDED else max(clamp, min(25.0 * error / flag, 1e-6))
        sizes = singular, flag, norm, clamp, further, fold
        return Tolerances(*sizes, error=error, lost=lost, moved=moved, shifted=shifted)

    def least(self, value: Expr, size: float) -> float:
        """How far outside its domain `value`, of natural size `size`, may be under a square root."""
        clamp = self.further if self.moved(value) > 0.0 else self.clamp
        least = max(clamp * size, min(_BESIDE * self.lost(value), self.wide * size))
        if self.error <= ROUNDED:
            return least
        off = _WORST * self.error * self.shifted(value)
        return max(least, min(off, _OUTSIDE * size))

    def guard(
        self, g: ExpressionGraph, value: Expr, size: float, largest: Expr | None = None
    ) -> Expr:
        """Condition that a square root of `value`, of natural size `size` and no larger than `largest`, may
        be taken."""
        outside = self.least(value, size)
        least = g.const(-outside)
        if self.error > ROUNDED and largest is not None and not largest.is_fixed:
            least = g.binary("min", least, g.mul(g.const(-outside / size), largest))
        rough = self.folded(value) if self.rough is None else self.rough
        if rough is not None:
            least = g.select(rough, g.const(-self.wide * size), least)
        real = g.binary("gt", value, least)
        margin = self.margin(value)
        if margin is None:
            return real
        reach = self.error * max(_MULTIPLIED * size, _FURTHER * self.moved(value))
        reach = min(max(reach, self.lost(value)), size)
        least = g.const((reach / (_OUTSIDE * size)) ** 2)
        far = g.mul(g.square(value), at_least(g, margin, least))
        return g.binary("or", real, g.binary("gt", g.const(reach**2), far))


@dataclass(frozen=True, slots=True)
class Divisor:
    """A divisor with 1 in its place where it vanishes; `regular`: it does not vanish; `clear`: it is well
    away from that. Both None where it is a nonzero constant. `magnitude` is what both compare, with the
    natural size `size` of the divisor to the power `power`."""

    value: Expr
    regular: Expr | None = None
    clear: Expr | None = None
    magnitude: Expr | None = None
    size: float = 1.0
    power: int = 1

    def above(self, g: ExpressionGraph, share: float) -> Expr | None:
        """Condition that the divisor exceeds a share of its natural size; None: it is constant."""
        if self.magnitude is None:
            return None
        limit = self.size * share if self.power == 1 else self.size * share**self.power
        return g.binary("gt", self.magnitude, g.const(limit))

    def square(self, g: ExpressionGraph) -> Expr | None:
        """Its square as a share of its natural size; None: it is constant."""
        if self.magnitude is None:
            return None
        share = g.mul(g.const(1.0 / self.size), self.magnitude)
        return share if self.power == 2 else g.square(share)


@dataclass(frozen=True, slots=True)
class LoweredForm:
    """`values`: (cosine, sine) or (distance,), defined where `regular` (None: always) holds, and well
    away from a continuum where `divisor.clear` does; `guard`: condition for a real solution (None: always);
    `branches`: how many signs of sigma differ; `under`: what is under the square root, and its natural
    size."""

    values: tuple[Expr, ...]
    divisor: Divisor
    guard: Expr | None
    branches: int
    under: tuple[Expr, Expr] | None = None

    @property
    def regular(self) -> Expr | None:
        """Condition that the divisor does not vanish."""
        return self.divisor.regular


@dataclass(frozen=True, slots=True)
class LoweredBranches:
    """A form of any number of branches, each with expressions of its own: `values` and `guards` are per
    branch what `LoweredForm` has for both signs; the divisor, and what is `under` a square root, are the
    same for all."""

    values: tuple[tuple[Expr, ...], ...]
    divisor: Divisor
    guards: tuple[Expr | None, ...]
    under: tuple[Expr, Expr] | None = None


@dataclass(frozen=True, slots=True)
class LoweredRoutine:
    """A form that a routine of the runtime solves: its name, its arguments, and the divisor where they
    do not determine the unknown."""

    routine: str
    arguments: tuple[Expr, ...]
    divisor: Divisor


def natural_size(e: Expr) -> float:
    """Natural size of an expression: its largest value at the probes."""
    finite = e.probe[np.isfinite(e.probe)]
    return float(np.max(np.abs(finite))) if finite.size else 1.0


def divisor_of(
    g: ExpressionGraph, value: Expr, tol: Tolerances, power: int = 1, *, squared: bool = False
) -> Divisor:
    """An expression as a divisor; `power` 2 where it is a sum of squares, whose bound leaves a direction
    more than half of the digits. One that is such a sum times a number may be `squared`: as small as these
    before it marks a continuum."""
    if value.is_fixed:
        return Divisor(value)
    size = natural_size(value)
    magnitude = g.unary("abs", value) if power == 1 else value
    found = Divisor(value, None, None, magnitude, size, power)
    off = min(tol.lost(value) / (power * size), tol.flag)
    regular = found.above(g, max(tol.singular, off))
    if tol.double is not None and regular is not None and power == 1:
        least = g.select(tol.double, g.const(_HALF_OF_DIGITS * size), regular.args[1])
        regular = g.binary("gt", magnitude, least)
    clear = found.above(g, tol.norm if power == 2 else tol.norm**2 if squared else tol.flag)
    assert regular is not None
    return Divisor(g.select(regular, value, g.one), regular, clear, magnitude, size, power)


def leading(g: ExpressionGraph, coefficients: tuple[Expr, ...], tol: Tolerances) -> Divisor:
    """The sum of the squares of coefficients, as a divisor: where it vanishes the unknown is free."""
    return divisor_of(g, g.dot([*coefficients], [*coefficients]), tol, 2)


def sign_of_squares(e: Expr) -> int:
    """1 of a sum of squares, -1 of one that is subtracted, 0 of what is written as neither."""
    if e.is_const:
        return int(np.sign(e.value))
    if e.op == "neg":
        return -sign_of_squares(e.args[0])
    if e.op == "mul":
        a, b = e.args
        return 1 if a is b else sign_of_squares(a) * sign_of_squares(b)
    if e.op not in ("add", "sub"):
        return 0
    one, other = map(sign_of_squares, e.args)
    return one if one == (other if e.op == "add" else -other) else 0


def at_least(g: ExpressionGraph, value: Expr, least: Expr) -> Expr:
    """max(value, least), for least >= 0."""
    return value if least is g.zero else g.binary("max", value, least)
