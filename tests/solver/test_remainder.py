"""What is left of a chain: which equations are told, how many, and in which order."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from ikgen.equations.knowledge import UNREADABLE, PolynomialEquation, Variable
from ikgen.solver.remainder import OpenEquation, _degree, count_open, near_misses, open_equations

X, Y, Z = (Variable("angle", one) for one in ((1, 0, 0), (0, 1, 0), (0, 0, 1)))


class Equations:
    """A graph with equations of these ranks (0 and 1: of the two sides) and sizes, told by number; what
    `hides` has no unknowns once it is a polynomial."""

    def __init__(self, *ranks: int, sizes: tuple[int, ...] = (), hides: int = -1) -> None:
        self.equations = [
            SimpleNamespace(
                left=SimpleNamespace(id=10 * i, support=rank, size=size),
                right=SimpleNamespace(id=10 * i + 1, support=0, size=100),
                label=f"({i},1) px", number=i,
            )
            for i, (rank, size) in enumerate(zip(ranks, sizes or ranks, strict=True))
        ]  # fmt: skip
        self.hides = hides
        self.known = SimpleNamespace(
            equations=self, unknown_rank=lambda s: s, polynomial_equation=self.polynomial
        )

    def workspace(self) -> SimpleNamespace:
        return self.known

    def polynomial(self, e: SimpleNamespace) -> PolynomialEquation:
        unknowns = () if e.number == self.hides else (X, Y, Z)[: e.left.support]
        return PolynomialEquation({}, unknowns, (e,), len(unknowns))

    def opened(self, most: int = 40) -> list[int]:
        found = open_equations(self, lambda side: side.size, most)
        assert all(one.size == one.equation.left.size + 100 for one in found)
        assert [one.rank for one in found] == sorted(one.rank for one in found)
        return [one.equation.number for one in found]


def test_equations_without_unknowns_or_with_unread_entries_are_not_open() -> None:
    graph = Equations(0, 1, 2, UNREADABLE, 3)
    assert count_open(graph) == 3 and graph.opened() == [1, 2, 4]


def test_an_equation_is_told_once() -> None:
    graph = Equations(2, 1, 3)
    graph.equations.append(graph.equations[1])
    assert count_open(graph) == 3 and graph.opened() == [1, 0, 2]


def test_the_fewest_unknowns_come_first_then_the_shortest() -> None:
    graph = Equations(2, 1, 2, 1, 3, sizes=(7, 9, 5, 3, 1))
    assert graph.opened() == [3, 1, 2, 0, 4]
    assert [graph.opened(most) for most in (1, 3)] == [[3], [3, 1, 2]]


def test_what_has_no_unknowns_left_gives_its_place_to_another() -> None:
    graph = Equations(2, 1, 2, 1, 3, sizes=(7, 9, 5, 3, 1), hides=3)
    assert graph.opened(2) == [1, 2]


def equation(size: int, *unknowns: Variable, twice: Variable | None = None) -> OpenEquation:
    """An equation in some unknowns, one of them in the second degree."""
    polynomial = {(((v.combination, "c"),), ()): 1.0 for v in unknowns}
    if twice is not None:
        polynomial[((twice.combination, "c"), (twice.combination, "s")), ()] = 1.0
    made = PolynomialEquation(polynomial, unknowns, (), len(unknowns))
    return OpenEquation(SimpleNamespace(label=str(size)), made, size)


def test_the_nearest_leaf_lacks_the_fewest_then_is_the_simplest_then_the_shortest() -> None:
    many = equation(1, X, Y, Z)
    quartic, long, short = equation(2, X, Y, twice=Y), equation(9, X, Y), equation(5, Y, Z)
    alone = equation(30, Z)
    found = near_misses([many, quartic, long, short, alone])
    assert found[0].source is alone and found[0].lacking == ()
    told = [(miss.source.size, miss.unknown) for miss in found]
    assert told == [
        (30, Z), (2, X), (5, Z), (5, Y), (9, Y), (9, X), (2, Y), (1, Z), (1, Y), (1, X),
    ]  # fmt: skip
    assert found[1].lacking == (Y,) and found[-1].lacking == (Y, Z)
    assert [miss.leaf for miss in found if miss.leaf != "sine and cosine"] == ["quartic"]


@pytest.mark.parametrize("v", [X, Variable("prismatic", (0, 1, 0))])
def test_an_unknown_that_does_not_occur_is_of_degree_zero(v: Variable) -> None:
    for polynomial in ({}, {((), ()): 1.0}, {((((0, 1, 1), "c"),), ((2, 3),)): 1.0}):
        assert _degree(PolynomialEquation(polynomial, (), (), 0), v) == 0


def test_forty_equations_are_enough_to_tell() -> None:
    assert len(Equations(*[1] * 50).opened()) == 40 and count_open(Equations(*[1] * 50)) == 50
    assert len(open_equations(Equations(*[1] * 50), lambda side: side.size)) == 40
