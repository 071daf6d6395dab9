"""What an open equation could be solved for, by its degree in the unknown."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from ikgen.equations.knowledge import Variable
from ikgen.solver.leaves import LEAVES
from ikgen.solver.remainder import _degree, _leaf

ANGLE, LENGTH = Variable("angle", (1, 0)), Variable("prismatic", (0, 1))
OTHER = (0, 1)


@pytest.mark.parametrize(
    ("v", "degree", "leaf"),
    [
        (LENGTH, 1, "algebraic"),
        (LENGTH, 2, "quadratic"),
        (ANGLE, 1, "sine and cosine"),
        (ANGLE, 2, "quartic"),
    ],
)
def test_the_form_follows_from_the_degree(v: Variable, degree: int, leaf: str) -> None:
    assert _leaf(v, degree) == leaf and leaf in {one.name for one in LEAVES}
    trigs = (((1, 0), "c"),) * (degree if v is ANGLE else 1) + ((OTHER, "s"),)
    slides = ((1, degree if v is LENGTH else 1), (0, 5))
    equation = SimpleNamespace(polynomial={(trigs, ()): 1.0, ((), slides): 1.0, ((), ()): 1.0})
    assert _degree(equation, v) == degree
