"""What solved unknowns leave of the file's digits."""

from __future__ import annotations

import numpy as np
from tests.support.probed import given

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.lowering.file_digits import FileDigits

FIRST, SECOND = np.array([0.5, 1e-3, 0.5, 1e-3, 0.0]), np.array([0.4, 0.4, 1e-4, 1e-4, 1e-4])
LEAST = 1e-6


class Bench:
    """Unknowns one after the other, each solved from values of those before it."""

    def __init__(self) -> None:
        self.g = ExpressionGraph(len(FIRST))
        self.definition: dict[int, Expr] = {}
        self.digits = FileDigits(self.g, self.definition, LEAST)

    def solve(self, *values: Expr, squares: tuple[np.ndarray, ...] = ()) -> Expr:
        """An unknown that follows from these values."""
        for one in squares:
            self.digits.note(given(self.g, one))
        atom = given(self.g, np.ones(len(FIRST)))
        self.definition[atom.id] = self.g.add(*values) if len(values) == 2 else values[0]
        self.digits.settle([atom], values)
        return atom

    def left(self, *values: Expr) -> list[float] | None:
        found = self.digits.behind(*values)
        return None if found is None else list(found.probe)


def test_what_follows_from_the_pose_alone_loses_nothing() -> None:
    b = Bench()
    pose = given(b.g, FIRST)
    assert b.left(pose) is None
    assert b.left(b.solve(pose)) is None


def test_of_a_divisor_and_the_root_beside_it_the_smaller_counts() -> None:
    b = Bench()
    q = b.solve(given(b.g, FIRST), squares=(FIRST, SECOND))
    assert b.left(q) == list(np.maximum(np.minimum(FIRST, SECOND), LEAST))


def test_an_unknown_loses_what_those_before_it_do_times_its_own() -> None:
    """Through an unknown that itself loses nothing, too."""
    b = Bench()
    q1 = b.solve(given(b.g, FIRST), squares=(FIRST,))
    q2 = b.solve(b.g.square(b.solve(q1)), squares=(SECOND,))
    expected = np.maximum(FIRST, LEAST) * np.maximum(SECOND, LEAST)
    np.testing.assert_allclose(b.left(q2) or (), expected, rtol=1e-14)
    assert b.left(q1) == list(np.maximum(FIRST, LEAST))


def test_unknowns_side_by_side_lose_what_the_worse_does() -> None:
    b = Bench()
    q1 = b.solve(given(b.g, FIRST), squares=(FIRST,))
    q2 = b.solve(given(b.g, SECOND), squares=(SECOND,))
    least = np.minimum(np.maximum(FIRST, LEAST), SECOND)
    assert b.left(q1, q2) == b.left(b.solve(q1, q2)) == list(least)
