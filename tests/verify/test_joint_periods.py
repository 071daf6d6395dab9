"""Which values of a joint are the same configuration, and what drives joints that follow others."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from numpy.typing import NDArray

from ikgen.errors import BadDescriptionError
from ikgen.verify.oracle import _resolve
from ikgen.verify.pinocchio_model import Oracle

TURN = 2.0 * np.pi
TURNING, SLIDING = [0.0, 0, 0, 0, 0, 1], [0.0, 0, 1, 0, 0, 0]


def oracle(screws: list[list[float]], A: list[list[float]]) -> SimpleNamespace:
    made = SimpleNamespace(screws=SimpleNamespace(screws=np.array(screws), A=np.array(A)))
    made.revolute = Oracle.revolute.fget(made)  # type: ignore[attr-defined]
    return made


def period(
    screws: list[list[float]], A: list[list[float]], limit: float = 1.0
) -> NDArray[np.float64]:
    span = np.full(np.shape(A)[1], 2.0 * limit)
    found: NDArray[np.float64] = Oracle.periods(oracle(screws, A), span)  # type: ignore[arg-type]
    return found


@pytest.mark.parametrize(
    ("factors", "turns"),
    [
        ((1.0,), 1.0),
        ((2.0,), 0.5),
        ((0.5,), 2.0),
        ((1.0, -2.0), 1.0),
        ((0.5, -0.5), 2.0),
        ((2.0, -3.0), 1.0),
        ((4.0, 6.0), 0.5),
        ((-3.0, 0.0), 1 / 3),
    ],
)
def test_the_slowest_axis_tells_the_period(factors: tuple[float, ...], turns: float) -> None:
    found = period([TURNING] * len(factors), [[f] for f in factors])
    assert found == pytest.approx([turns * TURN])


def test_there_is_none_where_it_takes_several_turns_or_something_slides() -> None:
    assert np.isinf(period([TURNING, TURNING], [[1.0], [1.5]])).all()
    for limit in (TURN, TURN - 1e-3, np.inf):  # both turns of the joint are inside
        assert period([TURNING, TURNING], [[1.0], [1.5]], limit)[0] == 2.0 * TURN
    assert np.isinf(period([TURNING, TURNING], [[1.0], [1.51]], np.inf)).all()
    assert np.isinf(period([TURNING, TURNING], [[0.5], [-1.5]])).all()
    assert np.isinf(period([TURNING, TURNING], [[2.0], [2.5]])).all()
    assert np.isinf(period([SLIDING], [[1.0]])).all()
    assert np.isinf(period([TURNING, SLIDING], [[1.0], [0.1]])).all()
    found = period([TURNING, SLIDING, TURNING], [[1.0, 0, 0], [0, 1.0, 0], [0, 0, 2.0]])
    assert found.tolist() == pytest.approx([TURN, np.inf, 0.5 * TURN])


def test_a_joint_that_moves_nothing_turns() -> None:
    made = oracle([SLIDING, TURNING], [[1.0, 0, 0], [0, 1.0, 0]])
    assert made.revolute.tolist() == [False, True, True]
    assert period([SLIDING, TURNING], [[1.0, 0, 0], [0, 1.0, 0]])[2] == pytest.approx(TURN)


def test_what_drives_a_joint() -> None:
    text = SimpleNamespace(mimic={"b": ("a", 2.0, 0.1), "c": ("b", -0.5, 0.3), "x": ("y", 1.0, 0.0),
                                  "y": ("x", 1.0, 0.0)})  # fmt: skip
    assert _resolve("a", text, ("z", "a"), {}) == (1, 1.0, 0.0)
    assert _resolve("b", text, ("a",), {}) == (0, 2.0, 0.1)
    assert _resolve("c", text, ("a",), {}) == (0, -1.0, pytest.approx(0.3 - 0.5 * 0.1))
    assert _resolve("c", text, ("b",), {"a": 9.0}) == (0, -0.5, 0.3)
    assert _resolve("c", text, (), {"a": 0.4}) == (None, 0.0, pytest.approx(0.25 - 0.4))
    assert _resolve("c", text, (), {}) == (None, 0.0, pytest.approx(0.25))
    assert _resolve("c", text, (), {"b": 0.4}) == (None, 0.0, pytest.approx(0.3 - 0.2))
    assert _resolve("alone", text, ("a",), {}) == (None, 0.0, 0.0)
    with pytest.raises(BadDescriptionError, match=r"joint [xy] mimics itself in a circle"):
        _resolve("x", text, ("a",), {})
