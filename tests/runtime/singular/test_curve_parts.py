"""Solutions on parts of curves."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from ikgen.runtime.python.arrays.angles import WHOLE_TURN
from ikgen.runtime.python.singular import curve_parts
from ikgen.runtime.python.singular.curve_parts import Parts, look, look_between
from ikgen.runtime.python.singular.fold_pair import Reduced

Array = NDArray[np.float64]
POLICY = SimpleNamespace(arrived=0.5e-9, fold_reach=10.0)
LINE: Any = SimpleNamespace(moving=(0,), policy=POLICY, placing=(WHOLE_TURN,))


def give(monkeypatch: pytest.MonkeyPatch, sample: Callable[[Reduced], Reduced]) -> None:
    """Makes samples of any curve what a function makes of where they begin."""

    def sampled(arm: Any, at: Reduced, T: Array) -> tuple[Reduced, Array]:
        return sample(at), np.ones(len(T), dtype=bool)

    monkeypatch.setattr(curve_parts, "sampled", sampled)


def between(a: Reduced, b: Reduced) -> Parts:
    return Parts(a, b, np.zeros(1, np.intp), np.zeros(1), np.ones(1))


def on_line(x: Array, roots: Array) -> Reduced:
    """Samples of the polynomial with these roots, as if the error left along a joint were that."""
    left, slope = (np.polyval(p, x) for p in (np.poly(roots), np.polyder(np.poly(roots))))
    return Reduced(x[:, None], np.ones((len(x), 1)), np.ones((len(x), 1)), left, slope)


def test_samples_between_two_begin_near_the_curve(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of a circle: a chord is 0.02 off it. Whatever the sense of the directions at both ends."""
    plane: Any = SimpleNamespace(moving=(0, 1))
    give(monkeypatch, lambda at: at)

    def on_circle(angle: float) -> Reduced:
        c, s, zero = np.cos(angle), np.sin(angle), np.zeros(1)
        return Reduced(np.array([[c, s]]), np.array([[-s, c]]), np.zeros((1, 2)), zero, zero)

    parts = between(on_circle(0.0), on_circle(0.4))
    middle = curve_parts.between(plane, parts, np.array([0.5]), np.zeros((1, 4, 4)))
    assert np.abs(middle.q - on_circle(0.2).q).max() < 2e-3
    assert middle.still == pytest.approx(on_circle(0.2).still, abs=1e-12)
    turned = parts._replace(b=parts.b._replace(still=-parts.b.still))
    middle = curve_parts.between(plane, turned, np.array([0.5]), np.zeros((1, 4, 4)))
    assert np.abs(middle.q - on_circle(0.2).q).max() < 2e-3
    back = curve_parts.between(
        plane, between(parts.b, parts.a), np.array([0.5]), np.zeros((1, 4, 4))
    )
    assert back.q == pytest.approx(middle.q)


@pytest.mark.parametrize(
    "roots",
    [
        [0.11],
        [0.11, 0.16],
        [0.11, 0.22, 0.31],
        [-0.35, 0.3501],
        [0.11, 0.1101],
        [0.21, 0.21, -0.11],
        [5.0],
    ],
)
def test_all_roots_between_two_samples_are_found(
    roots: list[float], monkeypatch: pytest.MonkeyPatch
) -> None:
    ways = np.array(roots)
    give(monkeypatch, lambda at: on_line(at.q[:, 0], ways))
    a, b = on_line(np.array([-0.4]), ways), on_line(np.array([0.4]), ways)
    owner, found = look(LINE, between(a, b), np.zeros((1, 4, 4)), np.zeros(1, np.intp))
    wanted = sorted({x for x in roots if abs(x) < 0.4})
    assert not owner.any() and (np.diff(found[:, 0]) >= -1e-12).all()
    for x in wanted:
        assert np.abs(found[:, 0] - x).min() < (1e-4 if roots.count(x) > 1 else 1e-12)
    assert len(found) == len(wanted) or len(wanted) < len(roots)
    assert np.abs(np.polyval(np.poly(roots), found[:, 0])).max(initial=0.0) < 1e-8


@pytest.mark.parametrize("inside", [1e-2, 20.0], ids=["more than at the ends", "off the curve"])
def test_a_change_of_sign_from_one_curve_to_another_is_no_solution(
    inside: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    taken = []

    def leap(at: Reduced) -> Reduced:
        taken.append(len(at.q))
        return at._replace(left=np.full(len(at.q), inside), slope=np.zeros(len(at.q)))

    give(monkeypatch, leap)
    a, b = (on_line(np.array([x]), np.array([0.0])) for x in (-1e-3, 1e-3))
    _, found = look(LINE, between(a, b), np.zeros((1, 4, 4)), np.zeros(1, np.intp))
    assert not len(found) and taken == [1]


@pytest.mark.parametrize("off", [0.0, 1e-16, -1e-16])
@pytest.mark.parametrize("end", [-0.4, 0.4, 0.0])
def test_a_sample_at_a_solution_hides_no_other(
    end: float, off: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whatever sign round-off gives it."""
    ways = np.array([end, end + 6e-3 * (1.0 if end < 0.0 else -1.0)])

    def sample(at: Reduced) -> Reduced:
        s = on_line(at.q[:, 0], ways)
        return s._replace(left=np.where(at.q[:, 0] == end, off, s.left))

    give(monkeypatch, sample)
    a, b = (sample(on_line(np.array([x]), ways)) for x in (-0.4, 0.4))
    _, found = look(LINE, between(a, b), np.zeros((1, 4, 4)), np.zeros(1, np.intp))
    np.testing.assert_allclose(np.sort(found[:, 0]), np.sort(ways), atol=1e-9)


def test_where_values_are_round_off_before_they_are_nothing_the_way_tells(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """What is left jumps across 0 there, and the solution is as near as the way tells."""
    taken = []

    def steep(x: Array) -> Reduced:
        left = 3e-9 * np.sign(x - 0.1234567) + (x - 0.1234567) + 20.0 * (x - 0.1234567) ** 3
        return on_line(x, np.array([0.0]))._replace(
            left=left, slope=1.0 + 60.0 * (x - 0.1234567) ** 2
        )

    def sample(at: Reduced) -> Reduced:
        taken.append(len(at.q))
        return steep(at.q[:, 0])

    give(monkeypatch, sample)
    parts = between(steep(np.array([0.0])), steep(np.array([0.3])))
    found = curve_parts._closed_in(LINE, parts, np.zeros((1, 4, 4)))
    ends = [float(x.q[0, 0]) for x in (found.a, found.b)]
    assert min(abs(x - 0.1234567) for x in ends) < 1e-8 and len(taken) < 20


@pytest.mark.parametrize("least", [-0.01, -0.001, 1e-3])
def test_two_roots_in_a_dip_that_the_cubic_does_not_show_are_found(
    least: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """x^2 / (x^2 + 0.04), as steep at both ends as the cubic is high there, which stays above 0.2."""

    def dip(at: Reduced) -> Reduced:
        x = at.q[:, 0]
        hollow = x * x + 0.04
        return at._replace(left=x * x / hollow + least, slope=0.08 * x / hollow**2)

    give(monkeypatch, dip)
    a, b = (dip(on_line(np.array([x]), np.array([0.0]))) for x in (-0.19, 0.2))
    _, found = look(LINE, between(a, b), np.zeros((1, 4, 4)), np.zeros(1, np.intp))
    root = np.sqrt(0.04 * -least / (1.0 + least)) if least < 0.0 else 0.0
    wanted = [-root, root] if least < 0.0 else []
    np.testing.assert_allclose(np.sort(found[:, 0]), wanted, atol=1e-9)


def test_two_roots_in_a_dip_far_from_both_ends_show_by_a_cubic_that_turns_twice(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """1 + x / 2 - 1.3 w^2 / (x^2 + w^2), above 0.8 at both ends, and the cubic between them too."""
    w = 0.03

    def dip(at: Reduced) -> Reduced:
        x = at.q[:, 0]
        hollow = x * x + w * w
        slope = 0.5 + 2.6 * w * w * x / hollow**2
        return at._replace(left=1.0 + 0.5 * x - 1.3 * w * w / hollow, slope=slope)

    give(monkeypatch, dip)
    a, b = (dip(on_line(np.array([x]), np.array([0.0]))) for x in (-0.2, 0.12))
    values = curve_parts._bernstein(LINE, between(a, b))
    assert values.min() > 0.8
    _, found = look(LINE, between(a, b), np.zeros((1, 4, 4)), np.zeros(1, np.intp))
    assert len(found) == 2
    assert np.abs(dip(on_line(found[:, 0], np.array([0.0]))).left).max() < 1e-9


def test_two_solutions_are_found_that_the_cubic_between_others_hides(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Of four in a row the cubic through the outer ones has none inside."""
    roots = np.array([-1.0, -0.05, 0.05, 1.0])
    give(monkeypatch, lambda at: on_line(at.q[:, 0], roots))
    monkeypatch.setattr(curve_parts, "samples_beside", lambda arm, q, T: on_line(q[:, 0], roots))
    q, to = np.array([[-1.0]]), np.array([[1.0]])
    line: Any = SimpleNamespace(
        moving=(0,),
        policy=POLICY,
        period=(WHOLE_TURN,),
        placing=(WHOLE_TURN,),
    )
    whose, found = look_between(line, q, to, np.zeros((1, 4, 4)))
    assert not whose.any()
    gaps = np.abs(found[:, :1] - roots).min(axis=0)
    assert gaps.max() < 1e-9
    ends = between(on_line(q[:, 0], roots), on_line(to[:, 0], roots))
    _, few = look(line, ends, np.zeros((1, 4, 4)), np.zeros(1, np.intp))
    assert np.abs(few[:, 0]).min() > 0.9


def test_a_root_is_closed_in_against_the_sense_of_samples_too(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """In few steps, on a circle in a plane."""
    plane: Any = SimpleNamespace(moving=(0, 1), policy=POLICY, placing=(WHOLE_TURN,) * 2)
    counts = []

    def on_circle(at: Reduced) -> Reduced:
        counts.append(len(at.q))
        angle = np.arctan2(at.q[:, 1], at.q[:, 0])
        c, s = np.cos(angle), np.sin(angle)
        tangent = np.stack([-s, c], axis=1)
        sense = np.sign((tangent * at.still).sum(axis=1))[:, None]
        rise = np.cos(angle - 0.3) * sense[:, 0]
        q, still = np.stack([c, s], axis=1), sense * tangent
        return Reduced(q, still, at.out, np.sin(angle - 0.3), rise)

    give(monkeypatch, on_circle)
    for sense in (1.0, -1.0):
        places = np.array([[1.0, 0.0], [np.cos(0.5), np.sin(0.5)]])
        stills = sense * np.array([[0.0, 1.0], [-np.sin(0.5), np.cos(0.5)]])
        none = np.zeros(1)
        a, b = (
            on_circle(Reduced(q[None], still[None], np.ones((1, 1)), none, none))
            for q, still in zip(places, stills, strict=True)
        )
        counts.clear()
        _, found = look(plane, between(a, b), np.zeros((1, 4, 4)), np.zeros(1, np.intp))
        assert found == pytest.approx(np.array([[np.cos(0.3), np.sin(0.3)]]), abs=1e-12)
        assert len(counts) < 8
