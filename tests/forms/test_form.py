"""All six forms: values fit the pattern, the lowered form gives the same, and where they fail."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given as property_of
from hypothesis import settings
from hypothesis import strategies as st
from tests.support.probed import given, sign

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.forms.form import Form, scales
from ikgen.forms.linear_form import Linear
from ikgen.forms.lowered_form import LoweredForm, LoweredRoutine, Tolerances
from ikgen.forms.pair_form import LinearPair
from ikgen.forms.quadratic_form import Quadratic
from ikgen.forms.quartic_form import TrigQuartic
from ikgen.forms.sine_cosine_form import SineCosine
from ikgen.forms.tangent_form import Tangent
from ikgen.forms.trig_polynomial_form import TrigPolynomial
from ikgen.runtime.python.roots.trig_polynomial_roots import trig_polynomial_branches
from ikgen.runtime.python.roots.trig_quartic_roots import trig_quartic, trig_quartic_branches

PROBES = 8
LAST = PROBES - 1
Array = np.ndarray
Values = tuple[Array, ...]


@dataclass(frozen=True)
class Pattern:
    """How a form is filled in for a true unknown, and what of its equations is left at a value."""

    form: type[Form]
    coefficients: Callable[[np.random.Generator, Array], Sequence[Array]]
    rest: Callable[[Sequence[Array], Values], Array]
    on_circle: bool = True


def _random(rng: np.random.Generator, *shape: int) -> Array:
    return rng.uniform(0.3, 1.5, (*shape, PROBES)) * rng.choice((-1.0, 1.0), (*shape, PROBES))


def _linear(rng: np.random.Generator, u: Array) -> Sequence[Array]:
    a = _random(rng)
    return a, -a * u


def _quadratic(rng: np.random.Generator, u: Array) -> Sequence[Array]:
    a, other = _random(rng), _random(rng)
    return a, -a * (u + other), a * u * other


def _sine_cosine(rng: np.random.Generator, u: Array) -> Sequence[Array]:
    a, b = _random(rng, 2)
    return a, b, a * np.cos(u) + b * np.sin(u)


def _tangent(rng: np.random.Generator, u: Array) -> Sequence[Array]:
    k = _random(rng)
    return k * np.cos(u), k * np.sin(u)


def _pair(rng: np.random.Generator, u: Array) -> Sequence[Array]:
    a1, b1, a2 = _random(rng, 3)
    b2 = (b1 * a2 + _random(rng)) / a1
    c, s = np.cos(u), np.sin(u)
    return a1, b1, a1 * c + b1 * s, a2, b2, a2 * c + b2 * s


def _quartic(rng: np.random.Generator, u: Array) -> Sequence[Array]:
    a2, b2, a1, b1 = _random(rng, 4)
    parts = a2 * np.cos(2 * u) + b2 * np.sin(2 * u) + a1 * np.cos(u) + b1 * np.sin(u)
    return a2, b2, a1, b1, -parts


def _quartic_rest(e: Sequence[Array], v: Values) -> Array:
    c, s = v
    return e[0] * (c * c - s * s) + e[1] * 2 * s * c + e[2] * c + e[3] * s + e[4]


class ThreeTerms(TrigPolynomial):
    """Of the harmonics 1, 3 and 4 on the circle."""

    def __init__(self, *terms: Expr) -> None:
        super().__init__(terms, (1, 3, 4), (-np.pi, np.pi))


def _trig_polynomial(rng: np.random.Generator, u: Array) -> Sequence[Array]:
    terms = list(_random(rng, 6))
    return *terms, -_three_terms([*terms, 0.0 * u], u)


def _three_terms(e: Sequence[Array], u: Array) -> Array:
    parts = [(n, e[2 * i], e[2 * i + 1]) for i, n in enumerate((1, 3, 4))]
    return np.asarray(sum(a * np.cos(n * u) + b * np.sin(n * u) for n, a, b in parts) + e[6])


PATTERNS = {
    p.form.name: p
    for p in (
        Pattern(Linear, _linear, lambda e, v: e[0] * v[0] + e[1], False),
        Pattern(Quadratic, _quadratic, lambda e, v: e[0] * v[0] ** 2 + e[1] * v[0] + e[2], False),
        Pattern(SineCosine, _sine_cosine, lambda e, v: e[0] * v[0] + e[1] * v[1] - e[2]),
        Pattern(Tangent, _tangent, lambda e, v: e[0] * v[1] - e[1] * v[0]),
        Pattern(
            LinearPair,
            _pair,
            lambda e, v: (
                np.abs(e[0] * v[0] + e[1] * v[1] - e[2]) + np.abs(e[3] * v[0] + e[4] * v[1] - e[5])
            ),
        ),
        Pattern(TrigQuartic, _quartic, _quartic_rest),
        Pattern(ThreeTerms, _trig_polynomial, lambda e, v: _three_terms(e, np.arctan2(v[1], v[0]))),
    )
}
NAMES = sorted(PATTERNS)
RUNG = [n for n in NAMES if n not in (TrigQuartic.name, TrigPolynomial.name)]
"""Those that are lowered to expressions; the others are to a routine."""


def filled(name: str, seed: int) -> tuple[ExpressionGraph, Form, Values, Array]:
    """A form whose coefficients are given at the probes, and its true solution."""
    rng = np.random.default_rng(seed)
    pattern = PATTERNS[name]
    u = rng.uniform(-3.0, 3.0, PROBES)
    truth = (np.cos(u), np.sin(u)) if pattern.on_circle else (u,)
    graph = ExpressionGraph(PROBES)
    form = of(graph, name, pattern.coefficients(rng, u))
    return graph, form, truth, u


def of(graph: ExpressionGraph, name: str, coefficients: Sequence[Array]) -> Form:
    """A form with these coefficients at the probes."""
    return PATTERNS[name].form(*(given(graph, e) for e in coefficients))


def lowered(form: Form, graph: ExpressionGraph, sigma: float) -> LoweredForm:
    """The lowered form of one branch."""
    found = form.lower(graph, sign(graph, sigma), Tolerances())
    assert isinstance(found, LoweredForm)
    return found


def gap(a: Values, b: Values) -> Array:
    """Largest difference (PROBES,) of two values."""
    return np.max([np.abs(x - y) for x, y in zip(a, b, strict=True)], axis=0)


def holds(condition: object) -> Array:
    """Where a condition holds (PROBES,)."""
    return condition.probe > 0.5


def test_all_forms_are_here() -> None:
    found = {one.name for one in Form.__subclasses__() if one.__module__.startswith("ikgen.forms.")}
    assert found == set(PATTERNS)


@settings(max_examples=30, deadline=None)
@property_of(st.integers(0, 10**6))
@pytest.mark.parametrize("name", NAMES)
def test_values_fit_the_pattern_and_the_truth_is_among_them(name: str, seed: int) -> None:
    _, form, truth, _ = filled(name, seed)
    branches = form.values(form.probe)
    assert len(branches) == form.branches
    nearest = np.full(PROBES, np.inf)
    for values in branches:
        there = np.isfinite(values[0])
        rest = np.abs(PATTERNS[name].rest(form.probe, values))[there]
        assert rest.size == 0 or rest.max() < 1e-6
        if form.on_circle and len(values) == 2:
            assert np.abs(np.hypot(*values)[there] - 1.0).max(initial=0.0) < 1e-9
        nearest = np.fmin(nearest, gap(values, truth))
    assert nearest.max() < 1e-5


@settings(max_examples=30, deadline=None)
@property_of(st.integers(0, 10**6))
@pytest.mark.parametrize("name", RUNG)
def test_the_lowered_form_gives_the_same_values(name: str, seed: int) -> None:
    graph, form, _, _ = filled(name, seed)
    branches = form.values(form.probe)
    for sigma, values in zip((1.0, -1.0)[: form.branches], branches, strict=True):
        found = lowered(form, graph, sigma)
        assert found.branches == form.branches
        assert gap(tuple(e.probe for e in found.values), values).max() < 1e-6
        assert found.regular is not None and holds(found.regular).all()
        assert found.guard is None or holds(found.guard).all()


@settings(max_examples=30, deadline=None)
@property_of(st.integers(0, 10**6))
def test_the_quartic_s_routine_is_handed_its_coefficients(seed: int) -> None:
    graph, form, _, _ = filled(TrigQuartic.name, seed)
    found = form.lower(graph, graph.one, Tolerances())
    assert isinstance(found, LoweredRoutine) and found.routine == trig_quartic.__name__
    assert found.divisor.regular is not None and holds(found.divisor.regular).all()
    branches = np.array(form.values(form.probe))
    slope = np.array([_quartic_slope(form.probe, tuple(b)) for b in branches])
    for i in range(PROBES):
        there = np.isfinite(branches[:, 0, i])
        if np.abs(slope[there, i]).min() < 1e-2:
            continue  # two roots that nearly meet: whether they are real is a matter of digits
        expected = branches[there, :, i]
        roots = np.array(trig_quartic_branches(*(float(e.probe[i]) for e in found.arguments)))
        left = _quartic_rest([e.probe[i] for e in form.coefficients], tuple(roots.T))
        roots = roots[np.abs(left) < 1e-9]  # it may give a point beside: rows are checked later
        assert len(roots) == len(expected)
        apart = np.abs(expected[:, None, :] - roots[None]).max(axis=2)
        assert max(apart.min(axis=0).max(), apart.min(axis=1).max()) < 1e-7


def _quartic_slope(e: Sequence[Array], v: Values) -> Array:
    c, s = v
    return 2 * (e[1] * (c * c - s * s) - e[0] * 2 * s * c) + e[3] * c - e[2] * s


@pytest.mark.parametrize("name", NAMES)
def test_where_the_divisor_vanishes_no_branch_is_regular(name: str) -> None:
    graph, form, _, _ = filled(name, 1)
    parts = {id(e) for e in form.divisor_parts}
    coefficients = []
    for e in form.coefficients:
        probe = e.probe.copy()
        probe[LAST] *= id(e) not in parts
        coefficients.append(probe)
    flat = of(graph, name, coefficients)
    divisor = np.abs(flat.divisor(flat.probe, scales(flat.coefficients))).max(axis=0)
    assert divisor[LAST] == 0.0 and divisor[:LAST].min() > 1e-3
    found = flat.lower(graph, sign(graph, 1.0), Tolerances())
    regular, clear = found.divisor.regular, found.divisor.clear
    assert regular is not None and clear is not None
    for condition in (regular, clear):
        assert list(holds(condition)) == [True] * LAST + [False]
    if isinstance(found, LoweredForm):
        assert all(np.isfinite(e.probe).all() for e in found.values)


def _touching(name: str) -> tuple[ExpressionGraph, Form, Array]:
    """A form with two branches whose branches meet at the last probe, and the unknown there."""
    graph, form, _, u = filled(name, 4)
    e = [x.copy() for x in form.probe]
    if name == Quadratic.name:
        e[1][LAST], e[2][LAST] = -2 * e[0][LAST] * u[LAST], e[0][LAST] * u[LAST] ** 2
    else:
        e[2][LAST] = np.hypot(e[0][LAST], e[1][LAST])
        u[LAST] = np.arctan2(e[1][LAST], e[0][LAST])
    return graph, of(graph, name, e), u


@pytest.mark.parametrize("name", [Quadratic.name, SineCosine.name])
def test_the_discriminant_vanishes_where_branches_meet(name: str) -> None:
    _, form, u = _touching(name)
    one, two = form.values(form.probe)
    assert gap(one, two)[LAST] < 1e-7 < 1e-3 < gap(one, two)[:LAST].min()
    under = form.discriminant()
    assert under is not None and abs(under[LAST]) < 1e-14 < 1e-7 < under[:LAST].min()
    fold = form.fold(form.probe, scales(form.coefficients), u)
    if fold is not None:
        assert abs(fold[0, LAST]) < 1e-12 < 1e-4 < np.abs(fold[0, :LAST]).min()


def test_only_the_forms_with_a_square_root_fold() -> None:
    for name in NAMES:
        _, form, _, u = filled(name, 0)
        fold = form.fold(form.probe, scales(form.coefficients), u)
        assert (fold is not None) == (name == SineCosine.name)
        assert (form.discriminant() is not None) == (name in (SineCosine.name, Quadratic.name))


@pytest.mark.parametrize("name", [Quadratic.name, SineCosine.name])
def test_the_guard_fails_where_there_is_no_real_solution(name: str) -> None:
    graph, form, _ = _touching(name)
    e = [x.copy() for x in form.probe]
    e[2][LAST] += np.copysign(0.1, e[0][LAST] if name == Quadratic.name else e[2][LAST])
    off = of(graph, name, e)
    found = lowered(off, graph, 1.0)
    assert list(holds(found.guard)) == [True] * LAST + [False]
    assert holds(lowered(form, graph, 1.0).guard).all()  # at the boundary there is one
    assert all(np.isfinite(x.probe).all() for x in found.values)


@pytest.mark.parametrize("which", [0, 1])
@pytest.mark.parametrize("sigma", [1.0, -1.0])
def test_a_single_cosine_or_sine_needs_no_amplitude(which: int, sigma: float) -> None:
    graph = ExpressionGraph(PROBES)
    u = np.random.default_rng(2).uniform(-3.0, 3.0, PROBES)
    side = -2.0 * (np.cos(u), np.sin(u))[which]
    parts = [graph.zero, graph.zero]
    parts[which] = graph.const(-2.0)
    found = lowered(SineCosine(*parts, given(graph, side)), graph, sigma)
    assert found.regular is None
    values = [e.probe for e in found.values]
    np.testing.assert_allclose(-2.0 * values[which], side, atol=1e-12)
    np.testing.assert_allclose(np.hypot(*values), 1.0, atol=1e-12)
    assert (np.sign(values[1 - which]) == sigma).all()


def test_a_pair_with_a_fixed_determinant_has_no_condition() -> None:
    graph = ExpressionGraph(PROBES)
    c1, c2 = (given(graph, x) for x in np.random.default_rng(2).uniform(-1, 1, (2, PROBES)))
    numbers = [graph.const(x) for x in (2.0, 1.0, -1.0, 0.5)]
    form = LinearPair(numbers[0], numbers[1], c1, numbers[2], numbers[3], c2)
    found = lowered(form, graph, 1.0)
    assert found.regular is None and found.divisor.clear is None
    assert gap(tuple(e.probe for e in found.values), form.values(form.probe)[0]).max() < 1e-12


@pytest.mark.parametrize("sign", [1, -1])
def test_a_pair_that_is_a_rotation_divides_by_a_length_squared(sign: int) -> None:
    """The determinant of `[[a, b], [-b, a]]` or `[[a, b], [b, -a]]`: no zero but where both are."""
    graph = ExpressionGraph(PROBES)
    rng = np.random.default_rng(4)
    a, b, second = rng.uniform(-1.0, 1.0, (3, PROBES))
    u = rng.uniform(-3.0, 3.0, PROBES)
    c, s = np.cos(u), np.sin(u)
    e, f = given(graph, a), given(graph, b)
    below = (graph.neg(f), e) if sign > 0 else (f, graph.neg(e))
    sides = a * c + b * s, sign * (a * s - b * c)
    form = LinearPair(e, f, given(graph, sides[0]), *below, given(graph, sides[1]))
    assert form.rotation == sign and not form.is_determinant
    found = form.lower(graph, graph.one, Tolerances.for_model_error(1e-6))
    assert isinstance(found, LoweredForm)
    assert lowered(form, graph, 1.0).divisor.power == 2
    assert found.divisor.power == 2 and found.divisor.magnitude is not None
    np.testing.assert_allclose(found.divisor.magnitude.probe, a**2 + b**2, atol=1e-14)
    assert gap(tuple(v.probe for v in found.values), (c, s)).max() < 1e-11
    natural = form.divisor(form.probe, scales(form.coefficients))
    assert natural.shape == (2, PROBES)
    assert not form.turns_scaled or form.rotation
    other = LinearPair(e, f, form.c1, given(graph, second), given(graph, a), form.c2)
    assert not other.turns_scaled
    assert other.is_determinant and lowered(other, graph, 1.0).divisor.power == 1


def test_a_pair_that_is_a_rotation_but_for_constants_is_a_continuum_where_squares_are() -> None:
    """The determinant of `[[k a, k b], [-b, a]]` is `k (a^2 + b^2)`, whatever sign the constant has."""
    graph = ExpressionGraph(PROBES)
    a, b, c, d = np.random.default_rng(6).uniform(-1.0, 1.0, (4, PROBES))
    e, f, k = given(graph, a), given(graph, b), graph.const(-0.25)
    sides = given(graph, c), given(graph, d)
    form = LinearPair(graph.mul(k, e), graph.mul(k, f), sides[0], graph.neg(f), e, sides[1])
    other = LinearPair(graph.mul(k, e), graph.mul(k, f), sides[0], e, graph.neg(f), sides[1])
    assert form.turns_scaled and not form.rotation and not other.turns_scaled
    exact = Tolerances.for_model_error(0.0)
    found, plain = (one.lower(graph, graph.one, exact) for one in (form, other))
    assert isinstance(found, LoweredForm) and isinstance(plain, LoweredForm)
    assert found.divisor.clear is not None and plain.divisor.clear is not None
    size = found.divisor.size
    np.testing.assert_allclose(size, 0.25 * np.max(a**2 + b**2), rtol=1e-12)
    bounds = [one.divisor.clear.args[1].value / one.divisor.size for one in (found, plain)]
    assert bounds == pytest.approx([exact.norm**2, exact.flag], rel=1e-9)


@settings(deadline=None)
@property_of(st.floats(-3.1, 3.1))
def test_the_quartic_instead_has_the_seed_as_a_root(seed: float) -> None:
    graph, form, _, _ = filled(TrigQuartic.name, 3)
    pair = tuple(given(graph, np.full(PROBES, f(seed))) for f in (np.cos, np.sin))
    roots = trig_quartic_branches(*(float(e.probe[0]) for e in form.instead(graph, pair)))
    assert min(abs(np.hypot(c - np.cos(seed), s - np.sin(seed))) for c, s in roots) < 1e-9


def test_forms_without_a_routine_have_nothing_instead() -> None:
    graph, form, _, _ = filled(Linear.name, 0)
    with pytest.raises(NotImplementedError, match="linear"):
        form.instead(graph, (graph.one,))


def test_a_quartic_of_rounded_geometry_is_handed_how_far_a_root_may_be_complex() -> None:
    """What the geometry moves the polynomial by makes a pair of real roots a pair that is as far apart as
    its square root, at most 0.1 rad."""
    graph, form, _, _ = filled(TrigQuartic.name, 3)
    for error, wanted in ((1e-5, (25.0 * 1e-5) ** 0.5), (1e-2, 0.1)):
        found = form.lower(graph, graph.one, Tolerances.for_model_error(error))
        assert isinstance(found, LoweredRoutine) and found.routine == "trig_quartic_wide"
        assert found.arguments[:5] == form.coefficients
        assert found.arguments[5].value == pytest.approx(wanted)
    exact = form.lower(graph, graph.one, Tolerances.for_model_error(1e-12))
    assert isinstance(exact, LoweredRoutine) and exact.routine == "trig_quartic"


@settings(deadline=None)
@property_of(st.floats(-3.1, 3.1))
def test_a_trig_polynomial_s_instead_has_the_seed_as_a_root(seed: float) -> None:
    graph, form, _, _ = filled(TrigPolynomial.name, 3)
    pair = tuple(given(graph, np.full(PROBES, f(seed))) for f in (np.cos, np.sin))
    found = form.lower(graph, graph.one, Tolerances())
    instead = [*form.instead(graph, pair), *found.arguments[len(form.coefficients) :]]
    roots = trig_polynomial_branches(*(float(e.probe[0]) for e in instead))
    assert min(abs(np.hypot(c - np.cos(seed), s - np.sin(seed))) for c, s in roots) < 1e-9


def test_a_trig_polynomial_is_handed_to_its_routine_with_its_interval() -> None:
    graph, form, truth, u = filled(TrigPolynomial.name, 5)
    found = form.lower(graph, graph.one, Tolerances())
    assert isinstance(found, LoweredRoutine) and found.routine == "trig_polynomial"
    numbers = [float(e.probe[0]) for e in found.arguments[7:]]
    assert numbers == [1.0, 3.0, 4.0, -np.pi, np.pi, 1e-3, 6.0 + 2.0]
    wide = form.lower(graph, graph.one, Tolerances.for_model_error(1e-4)).arguments[-2]
    assert 1e-3 < float(wide.probe[0]) <= 0.1
    pair = tuple(given(graph, x) for x in truth)
    (left,), slope = form.pattern(graph, pair), form.slope(graph, pair)
    assert np.abs(left.probe).max() < 1e-12
    h, e = 1e-6, form.probe
    about = (_three_terms(e, u + h) - _three_terms(e, u - h)) / (2 * h)
    np.testing.assert_allclose(slope.probe, about, atol=1e-7)
    sizes = 4.0 * np.abs(np.stack(e)).max(axis=0)
    np.testing.assert_allclose(form.steepness(truth), np.abs(about) / sizes, atol=1e-7)
    for i in range(PROBES):
        roots = trig_polynomial_branches(*(float(x.probe[i]) for x in found.arguments))
        expected = np.array(form.values(e))[:, :, i]
        expected = expected[np.isfinite(expected[:, 0])]
        np.testing.assert_allclose(roots, expected, atol=1e-9)
