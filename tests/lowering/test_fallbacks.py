"""Which form gives an unknown's value: by the relative size of the first one's divisor."""

from __future__ import annotations

import numpy as np
import pytest
from tests.support.probed import given, sign
from tests.support.tables import table

from ikgen.algebra.expression import Expr
from ikgen.equations.knowledge import Variable
from ikgen.forms.form import Form
from ikgen.forms.linear_form import Linear
from ikgen.forms.lowered_form import LoweredForm, Tolerances
from ikgen.forms.quadratic_form import Quadratic
from ikgen.forms.sine_cosine_form import SineCosine
from ikgen.forms.tangent_form import Tangent
from ikgen.lowering.fallbacks import choose_form, picked
from ikgen.lowering.placement import Placement, Requirement
from ikgen.solver.solution_graph import SolutionGraph
from ikgen.solver.solve import solve_chain

SHARES = (1.0, 3e-2, 3e-3, 3e-4, 3e-6, 3e-9, 0.0)
"""Relative sizes of the divisor (of its square root for amplitudes) at the first probes."""


@pytest.fixture(scope="module")
def solved() -> SolutionGraph:
    return solve_chain(table(("R", "0", 0.0, 0.0), ("P", "1", 0.0, 0.0)))


class Bench:
    """A placement whose probes start with the shares above, and forms to choose from in it."""

    def __init__(self, solved: SolutionGraph, model_error: float = 0.0) -> None:
        self.work = Placement(solved, model_error)
        self.g = self.work.g
        self.angle = Variable("angle", (1, 0))
        self.length = Variable("prismatic", (0, 1))
        self.share = self.given(SHARES)

    def given(self, first: tuple[float, ...]) -> Expr:
        """An input with these values at the first probes, 1 at the others."""
        return given(self.g, [*first, *[1.0] * (self.g.probes - len(first))])

    def lowered(self, form: Form, sigma: Expr) -> LoweredForm:
        """The form lowered."""
        found = form.lower(self.g, sigma, Tolerances())
        assert isinstance(found, LoweredForm)
        return found

    def taken(self, v: Variable, first: Form, last: Form, sigma: float = 1.0) -> list[bool]:
        """At which of the first probes the value is the first form's; elsewhere it is the last's."""
        s = sign(self.g, sigma)
        forms = [self.lowered(form, s) for form in (first, last)]
        values = choose_form(self.work, v, forms, s)
        one, other = (np.array([e.probe for e in form.values]) for form in forms)
        both = np.array([e.probe for e in values])
        assert np.abs(one - other).max(axis=0).min() > 1e-3
        here = np.abs(both - one).max(axis=0) < 1e-12
        assert (np.abs(both - other).max(axis=0)[~here] < 1e-12).all()
        return [bool(x) for x in here[: len(SHARES)]]

    def solve(self, v: Variable, *forms: Form) -> Expr:
        """Solve for the variable; the share times a 1 that follows from it."""
        lowered = [form.lower(self.g, self.g.one, self.work.tolerances) for form in forms]
        found = [one for one in lowered if isinstance(one, LoweredForm)]
        self.work.define(v, choose_form(self.work, v, found, self.g.one))
        atom = self.work.atoms_of(v)[0]
        return self.g.mul(self.share, self.g.add(self.g.one, self.g.sub(atom, self.again(atom))))

    def again(self, atom: Expr) -> Expr:
        """An input of the same values."""
        return given(self.g, atom.probe)

    @property
    def requirements(self) -> list[np.ndarray]:
        """The conditions that were required, at the first probes."""
        items = [item for level in self.work.levels for item in level.items]
        found = [item.condition for item in items if isinstance(item, Requirement)]
        return [e.probe[: len(SHARES)] > 0.5 for e in found]


def test_a_small_linear_divisor_gives_way_to_the_fallback(solved: SolutionGraph) -> None:
    b = Bench(solved)
    first = Linear(b.share, b.g.neg(b.g.mul(b.share, b.g.const(2.0))))
    last = Linear(b.g.one, b.g.const(-3.0))
    assert b.taken(b.length, first, last) == [share > 1e-3 for share in SHARES]
    assert not b.requirements and not b.work.singular


def test_a_small_leading_coefficient_of_a_quadratic_does(solved: SolutionGraph) -> None:
    """Its two branches do not make its divisor a square."""
    b = Bench(solved)
    first = Quadratic(b.share, b.g.const(-20.0), b.g.const(5.0))
    last = Quadratic(b.g.one, b.g.zero, b.g.const(-9.0))
    assert b.taken(b.length, first, last) == [share > 1e-3 for share in SHARES]


def test_an_amplitude_counts_by_its_size_not_its_square(solved: SolutionGraph) -> None:
    b = Bench(solved)
    first = Tangent(b.g.mul(b.share, b.g.const(0.6)), b.g.mul(b.share, b.g.const(0.8)))
    last = Tangent(b.g.const(-0.8), b.g.const(0.6))
    assert b.taken(b.angle, first, last) == [share > 1e-3 for share in SHARES]


def test_branches_about_to_meet_give_way_too(solved: SolutionGraph) -> None:
    """`cos = 1 - ...`: the discriminant is as small as the share's square."""
    b = Bench(solved)
    root = b.g.sqrt(b.g.sub(b.g.one, b.g.mul(b.g.const(0.99), b.g.square(b.share))))
    meeting = SineCosine(b.given((1.0,)), b.g.zero, root)
    last = Tangent(b.g.const(-0.8), b.g.const(0.6))
    assert b.taken(b.angle, meeting, last) == [share > 1.1e-3 for share in SHARES]


def test_branches_about_to_meet_stay_where_the_fallback_is_small(solved: SolutionGraph) -> None:
    """Down to where they, and the fallback's divisor, are lost in rounding."""
    b = Bench(solved)
    root = b.g.sqrt(b.g.sub(b.g.one, b.g.mul(b.g.const(0.99), b.g.square(b.share))))
    meeting = SineCosine(b.given((1.0,)), b.g.zero, root)
    last = Tangent(b.g.mul(b.share, b.g.const(-0.8)), b.g.mul(b.share, b.g.const(0.6)))
    assert b.taken(b.angle, meeting, last) == [not 1e-4 < share < 1.1e-3 for share in SHARES]


def test_rounded_geometry_gives_way_earlier(solved: SolutionGraph) -> None:
    b = Bench(solved, model_error=1e-5)
    first = Linear(b.share, b.g.neg(b.g.mul(b.share, b.g.const(2.0))))
    last = Linear(b.g.one, b.g.const(-3.0))
    limit = 10.0 * 1e-5**0.5
    assert 3e-2 < limit < 0.1
    assert b.taken(b.length, first, last) == [share > limit for share in SHARES]


def test_the_seed_is_taken_where_all_fail(solved: SolutionGraph) -> None:
    b = Bench(solved)
    s = b.g.one
    c2, s2 = b.g.const(0.6), b.g.const(0.8)
    forms = [Tangent(b.g.mul(b.share, x), b.g.mul(b.share, y)) for x, y in ((c2, s2), (s2, c2))]
    values = choose_form(b.work, b.angle, [b.lowered(form, s) for form in forms], s)
    seed = [b.work.atom(f"seed_{x}1") for x in "cs"]
    np.testing.assert_array_equal(
        [e.probe[len(SHARES) - 1] for e in values], [e.probe[0] for e in seed]
    )
    for probe in (0, 4):  # the first of two that are as small
        np.testing.assert_allclose([e.probe[probe] for e in values], [0.6, 0.8])
    [free] = b.work.singular
    assert list(free.probe[: len(SHARES)] > 0.5) == [share < 1e-4 for share in SHARES]


def test_a_fallback_with_one_branch_counts_once(solved: SolutionGraph) -> None:
    for sigma in (1.0, -1.0):
        b = Bench(solved)
        first = Quadratic(b.share, b.g.const(-20.0), b.g.const(5.0))
        last = Linear(b.g.one, b.g.const(-3.0))
        b.taken(b.length, first, last, sigma)
        guards = np.logical_and.reduce(b.requirements)
        assert list(guards) == [share > 1e-3 or sigma > 0.0 for share in SHARES]


def test_a_guard_holds_where_its_form_is_taken_alone(solved: SolutionGraph) -> None:
    b = Bench(solved)
    first = Linear(b.share, b.g.neg(b.g.mul(b.share, b.g.const(2.0))))
    never = Quadratic(b.g.one, b.g.const(-10.0), b.given((26.0,) * len(SHARES)))
    b.taken(b.length, first, never)
    guards = np.logical_and.reduce(b.requirements)
    assert list(guards) == [share > 1e-3 for share in SHARES]


def test_a_small_square_is_noted_relative_to_its_size_where_digits_are_lost(
    solved: SolutionGraph,
) -> None:
    bench = Bench(solved)
    under = bench.given((1e-3, 3e-6, 1e-7, 0.0))
    bench.work.note_fold(under, 4.0)
    assert bench.work.folds == []
    bench.work.loses_digits = True
    bench.work.note_fold(under, 4.0)
    (flag,) = bench.work.folds
    assert flag.probe[:4].tolist() == [0.0, 1.0, 1.0, 1.0]
    assert bench.work.rough is flag


def test_a_guard_bounds_where_the_solution_is_real_where_that_is_said_alone(
    solved: SolutionGraph,
) -> None:
    bench = Bench(solved)
    one, other = (bench.g.binary("gt", bench.share, bench.g.const(c)) for c in (0.1, 0.2))
    bench.work.require(one)
    bench.work.require(other, fold=True)
    found = [item for level in bench.work.levels for item in level.items]
    assert [item.fold for item in found if isinstance(item, Requirement)] == [False, True]
    assert not Requirement(one).fold


FLAGS = {"always": True, "never": False, "one": (1.0, 1.0, 0.0, 0.0), "other": (0.0, 1.0, 1.0, 0.0)}


@pytest.mark.parametrize("mine", FLAGS)
@pytest.mark.parametrize("other", FLAGS)
def test_of_two_conditions_one_is_taken_where_a_third_holds(
    mine: str, other: str, solved: SolutionGraph
) -> None:
    b = Bench(solved)
    flags = {
        name: value if isinstance(value, bool) else b.g.binary("gt", b.given(value), b.g.const(0.5))
        for name, value in FLAGS.items()
    }
    here = (1.0, 0.0, 1.0, 0.0)
    condition = b.g.binary("gt", b.given(here), b.g.const(0.5))
    assert picked(b.g, None, flags[mine], flags[other]) is flags[mine]
    found = picked(b.g, condition, flags[mine], flags[other])
    one, two = (np.broadcast_to(FLAGS[name], 4).astype(bool) for name in (mine, other))
    shown = np.full(4, found) if isinstance(found, bool) else found.probe[:4] > 0.5
    assert shown.tolist() == np.where(np.array(here) > 0.5, one, two).tolist()


def test_a_divisor_of_the_size_of_what_the_geometry_is_off_comes_last(
    solved: SolutionGraph,
) -> None:
    """An offset of 0.1 mm, kept where the file is off by 0.01 mm, tells hardly a digit."""
    for error, comes_first in ((1e-5, False), (1e-7, True)):
        b = Bench(solved, model_error=error)
        small = b.given((1e-4,) * len(SHARES))
        small = b.g.mul(small, b.g.const(1.0))
        first = Linear(b.g.mul(b.share, b.given((1e-4,) * b.g.probes)), b.g.neg(small))
        last = Linear(b.g.one, b.g.const(-3.0))
        assert b.taken(b.length, first, last)[0] is comes_first


def test_a_root_may_be_outside_by_what_a_small_divisor_before_it_moved_it(
    solved: SolutionGraph,
) -> None:
    """What the only form divides by counts as its square, as what a square root is taken of; with a
    constant to fall back on nothing is divided by what is small, and exact rows are moved by nothing."""
    b = Bench(solved, 1e-5)
    tolerances = b.work.tolerances
    assert tolerances.margin(b.share) is None and tolerances.fold
    follows = b.solve(b.length, Linear(b.share, b.g.const(-3.0)))
    margin = b.work.tolerances.margin(follows)
    assert margin is not None and b.work.tolerances.margin(b.share) is None
    squares = np.maximum(np.square(SHARES), tolerances.fold)
    np.testing.assert_allclose(margin.probe[: len(SHARES)], squares)
    for error, forms in ((1e-5, 2), (0.0, 1)):
        other = Bench(solved, error)
        first = Linear(other.share, other.g.const(-3.0))
        last = Linear(other.g.one, other.g.const(-3.0))
        follows = other.solve(other.length, *(first, last)[:forms])
        assert other.work.tolerances.margin(follows) is None


def test_a_direction_is_not_lost_by_the_square_root_that_it_goes_with(
    solved: SolutionGraph,
) -> None:
    """Both parts of an amplitude and what is under the root vanish together at a wrist's singularity: the
    direction is off by the model error over the amplitude there, not over its square."""
    b = Bench(solved, 1e-6)
    least = b.work.tolerances.norm
    follows = b.solve(b.angle, SineCosine(b.share, b.g.mul(b.share, b.g.const(0.5)), b.g.zero))
    assert b.work.lost == []  # nothing comes before it
    b.solve(b.length, Linear(follows, b.g.const(-3.0)))
    (lost,) = b.work.lost
    found = lost.probe[: len(SHARES)] > 0.5
    assert found.tolist() == [share**2 < least for share in SHARES]


@pytest.mark.parametrize("error", [1e-2, 1e-6])
def test_rows_are_in_doubt_where_all_amplitudes_together_are_what_the_file_is_off(
    solved: SolutionGraph, error: float
) -> None:
    """Not by a divisor that vanishes on a surface, as a determinant does: no joint is free there."""
    b = Bench(solved, error)
    follows = b.solve(b.angle, SineCosine(b.share, b.g.zero, b.g.zero))
    second = SineCosine(follows, b.g.zero, b.g.zero).lower(b.g, b.g.one, b.work.tolerances)
    assert isinstance(second, LoweredForm)
    choose_form(b.work, b.angle, [second], b.g.one)
    (doubt,) = b.work.doubts
    found = doubt.probe[: len(SHARES)] > 0.5
    assert found.tolist() == [
        max(share**2, b.work.tolerances.fold) * share**2 < error**2 for share in SHARES
    ]
    plain = b.lowered(Linear(follows, b.g.const(-3.0)), b.g.one)
    choose_form(b.work, b.length, [plain], b.g.one)
    assert b.work.doubts == [doubt] and len(b.work.lost) == 2
