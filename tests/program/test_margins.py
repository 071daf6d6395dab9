"""Numbers that say how far a condition is from changing."""

from __future__ import annotations

import pytest

from ikgen.program.interpret import evaluate
from ikgen.program.margins import margin
from ikgen.program.ops import Op

SQUARE = Op("mul", ("size", Op("mul", ("x", "x"))))
BESIDE = Op("or", (Op("gt", ("x", -1e-5)), Op("gt", (1e-10, SQUARE))))


def value(condition: Op, **names: float) -> float:
    return float(evaluate(margin(condition), names))


@pytest.mark.parametrize("x", [-1e-3, -1.1e-5, -9e-6, 0.0, 9e-6, 1e-3])
def test_the_sign_is_that_of_the_condition(x: float) -> None:
    for condition in (BESIDE, BESIDE.args[1]):
        assert (value(condition, x=x, size=0.5) > 0.0) == bool(
            evaluate(condition, {"x": x, "size": 0.5})
        )


def test_a_square_below_a_bound_is_as_far_as_what_is_squared() -> None:
    """A margin that stays next to nothing behind a fold would say nothing of how far that is."""
    assert value(BESIDE, x=-1e-3, size=0.5) == pytest.approx(1e-5 - 0.5**0.5 * 1e-3)
    assert value(BESIDE, x=-1e-4, size=1.0) == pytest.approx(1e-5 - 1e-4)
    assert value(Op("gt", (1e-6, Op("mul", ("x", "y")))), x=2.0, y=3.0) == 1e-6 - 6.0
