"""The interpreter: every operation, the order of branches, guards, routines and flags."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.support.pan_lift import pan_lift

from ikgen.program.inputs import SeedValue
from ikgen.program.interpret import _BINARY, _UNARY, Row, evaluate, run
from ikgen.program.ops import BOOLEAN, Op, operand_names, renamed
from ikgen.program.routines import TRIG_QUARTIC
from ikgen.program.statements import (
    Call,
    Comment,
    Constant,
    JointOutput,
    Let,
    Level,
    Program,
    Require,
)

MEANING = {
    "add": lambda a, b: a + b,
    "sub": lambda a, b: a - b,
    "mul": lambda a, b: a * b,
    "div": lambda a, b: a / b,
    "max": lambda a, b: a if a > b else b,
    "min": lambda a, b: a if a < b else b,
    "gt": lambda a, b: 1.0 if a > b else 0.0,
    "atan2": lambda a, b: math.atan2(a, b),
    "neg": lambda a: 0.0 - a,
    "abs": lambda a: a if a > 0 else -a,
    "sqrt": lambda a: a**0.5 if a > 0 else 0.0,
    "cos": lambda a: math.sin(a + math.pi / 2),
    "sin": lambda a: math.cos(a - math.pi / 2),
}
NUMBERS = st.floats(-4.0, 4.0).filter(lambda x: abs(x) > 1e-3)


def empty(**changes: object) -> Program:
    """A Program of one output, x."""
    level = Level(1, None, None, ())
    program = Program("p", (), (), (SeedValue(0),), (), (level,), (JointOutput(0, "x"),), ())
    return replace(program, **changes)


def test_every_operation_is_covered() -> None:
    assert set(MEANING) | {"and", "or", "not"} == set(_UNARY) | set(_BINARY)
    assert set(_UNARY) == {"neg", "abs", "sqrt", "cos", "sin", "not"}


@given(NUMBERS, NUMBERS)
@pytest.mark.parametrize("op", MEANING)
def test_operations_on_numbers(op: str, a: float, b: float) -> None:
    args = (a,) if op in _UNARY else (a, b)
    named = dict(zip("ab", args, strict=False))
    expected = MEANING[op](*args)
    assert evaluate(Op(op, args), {}) == pytest.approx(expected, abs=1e-12)
    assert evaluate(Op(op, tuple(named)), named) == evaluate(Op(op, args), {})
    assert op not in BOOLEAN or expected in (0.0, 1.0)


@pytest.mark.parametrize("a", [0.0, 1.0])
@pytest.mark.parametrize("b", [0.0, 1.0])
def test_operations_on_conditions(a: float, b: float) -> None:
    assert evaluate(Op("and", (a, b)), {}) == float(a and b)
    assert evaluate(Op("or", (a, b)), {}) == float(a or b)
    assert evaluate(Op("not", (a,)), {}) == 1.0 - a
    assert evaluate(Op("select", (a, 5.0, 7.0)), {}) == (5.0 if a else 7.0)


def test_operations_nest_and_names_are_found_and_changed() -> None:
    nested = Op("sub", ("x", Op("mul", (2.0, Op("neg", ("y",))))))
    assert evaluate(nested, {"x": 1.0, "y": 3.0}) == 7.0
    assert operand_names(nested) == {"x", "y"}
    assert operand_names(2.0) == set()
    assert renamed(nested, {"y": "z"}) == Op("sub", ("x", Op("mul", (2.0, Op("neg", ("z",))))))


def test_parameters_constants_and_prelude_come_first_and_in_order() -> None:
    program = empty(
        parameters=(Constant("a_1", 2.0),),
        constants=(Let("k1", Op("mul", ("a_1", 3.0))), Let("k2", Op("add", ("k1", 1.0)))),
        prelude=(Let("y", Op("add", ("seed_q1", "k2"))),),
        outputs=(JointOutput(0, Op("add", ("y", "a_1"))),),
    )
    assert run(program, {"seed_q1": 10.0}) == [Row((19.0,), False)]


def branching(*bodies: tuple[Let | Require | Comment, ...]) -> Program:
    """A level with two branches a body, and all their signs as a number: 11, 10, 1, 0 ..."""
    levels = tuple(
        Level(2, f"s{i}", None, (Comment(f"level {i}"), *body)) for i, body in enumerate(bodies)
    )
    value: Op | float = 0.0
    for i in range(len(bodies)):
        value = Op("add", (Op("mul", (10.0, value)), Op("gt", (f"s{i}", 0.0))))
    return empty(levels=levels, outputs=(JointOutput(0, value),))


def test_branches_come_depth_first_plus_before_minus() -> None:
    program = branching((), (), ())
    found = [row.q[0] for row in run(program, {})]
    assert found == [111.0, 110.0, 101.0, 100.0, 11.0, 10.0, 1.0, 0.0]
    assert len(found) == program.max_solutions


def test_a_guard_ends_its_branch_alone() -> None:
    body = (Let("x", Op("mul", ("s0", "s1"))), Require(Op("gt", ("x", 0.0))))
    assert [row.q[0] for row in run(branching((), body), {})] == [11.0, 0.0]
    assert run(branching((Require(0.0),), ()), {}) == []


def test_names_of_one_branch_are_not_seen_in_another() -> None:
    first = Let("x", Op("select", (Op("gt", ("s0", 0.0)), 1.0, 2.0)))
    program = replace(branching((first,), ()), outputs=(JointOutput(0, "x"),))
    assert [row.q[0] for row in run(program, {})] == [1.0, 1.0, 2.0, 2.0]


def test_a_routine_gives_as_many_branches_as_it_finds() -> None:
    call = Call(TRIG_QUARTIC, ("seed_q1", 2.0), ("u", "v"))
    level = Level(4, None, call, (Let("x", Op("sub", ("u", "v"))),))
    program = empty(levels=(Level(1, None, None, ()), level))

    def roots(a: float, b: float) -> list[tuple[float, ...]]:
        return [(a + k, b) for k in range(3)]

    found = run(program, {"seed_q1": 5.0}, {TRIG_QUARTIC.name: roots})
    assert [row.q[0] for row in found] == [3.0, 4.0, 5.0]
    assert run(program, {"seed_q1": 5.0}, {TRIG_QUARTIC.name: lambda *_: []}) == []


def test_a_row_is_singular_where_any_flag_holds() -> None:
    flags = (Let("f", Op("gt", ("s0", 0.0))), Let("g", Op("gt", ("s0", 2.0))))
    program = replace(branching(flags), singular=("f", "g"))
    assert [row.singular for row in run(program, {})] == [True, False]


def test_a_whole_program_gives_the_pose_s_joint_values() -> None:
    program = pan_lift().program
    pan, lift = 0.8, 0.2
    inputs = {"t03": 0.3 * math.cos(pan), "t13": 0.3 * math.sin(pan), "t23": lift}
    assert [row.q for row in run(program, inputs)] == [pytest.approx((pan, lift))]
    assert run(program, {**inputs, "t13": 0.5}) == []
