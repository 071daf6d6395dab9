"""Values that both branches of a level share are computed once, and are the same values."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.support.tables import table

from ikgen.equations.probes import dh_pose
from ikgen.lowering.lower import lower
from ikgen.model.dh import DHChain
from ikgen.program.branch_symmetry import with_shared_branches
from ikgen.program.inputs import PoseEntry, SeedValue
from ikgen.program.interpret import Row, run
from ikgen.program.ops import Op, Operand, operand_names
from ikgen.program.routines import TRIG_QUARTIC
from ikgen.program.statements import (
    Call,
    Comment,
    JointOutput,
    Let,
    Level,
    Program,
    Require,
    Statement,
)
from ikgen.solver.solve import solve_chain

SPHERICAL_WRIST = table(
    ("R", "0", 0.0, 0.4), ("R", "1", 0.1, 0.0), ("R", "0", 0.5, 0.0),
    ("R", "1", 0.05, 0.6), ("R", "-1", 0.0, 0.0), ("R", "1", 0.0, 0.1),
)  # fmt: skip
PARALLEL_AXES = table(
    ("R", "0", 0.0, 0.2), ("R", "1", 0.0, 0.0), ("R", "0", 0.5, 0.0),
    ("R", "0", 0.4, 0.1), ("R", "1", 0.0, 0.1), ("R", "-1", 0.0, 0.1),
)  # fmt: skip
SLIDE = table(
    ("R", "0", 0.0, 0.3), ("R", "1", 0.1, 0.0), ("P", "1", 0.0, 0.2),
    ("R", "0", 0.0, 0.0), ("R", "-1", 0.0, 0.0), ("R", "1", 0.0, 0.1),
)  # fmt: skip
ARMS = [SPHERICAL_WRIST, PARALLEL_AXES, SLIDE]


def program(
    *levels: tuple[Statement, ...], solved: tuple[str, ...] = (), **more: object
) -> Program:
    """Levels after the first are told by sigma_1, sigma_2, ...; `solved` of the last one. Results are the
    names that end in `out`."""
    made = [Level(1, None, None, levels[0])]
    for k, body in enumerate(levels[1:], 1):
        made.append(Level(2, f"sigma_{k}", None, body, solved if k == len(levels) - 1 else ()))
    lets = [s.name for body in levels for s in body if isinstance(s, Let)]
    outputs = tuple(JointOutput(j, n) for j, n in enumerate(n for n in lets if n.endswith("out")))
    inputs = (PoseEntry(0, 0), PoseEntry(0, 1))
    given = {"singular": (), **more}
    return Program("p", (), (), inputs, (), tuple(made), outputs, **given)  # type: ignore[arg-type]


def op(name: str, *args: Operand) -> Op:
    return Op(name, args)


def body(found: Program, index: int) -> dict[str, Operand]:
    """Names and values of a level."""
    return {s.name: s.value for s in found.levels[index].body if isinstance(s, Let)}


def operations(operand: Operand) -> set[str]:
    """The operations in an operand."""
    if not isinstance(operand, Op):
        return set()
    return {operand.op}.union(*(operations(a) for a in operand.args))


def rows(found: Program, *values: float) -> list[Row]:
    return run(found, dict(zip(("t00", "t01"), values, strict=True)))


# -- arms -----------------------------------------------------------------------------------------


@pytest.fixture(scope="module", params=ARMS, ids=["spherical wrist", "parallel axes", "slide"])
def arm(request: pytest.FixtureRequest) -> tuple[DHChain, Program]:
    return request.param, lower(solve_chain(request.param))


@pytest.mark.parametrize("least", [2, 8])
def test_rows_are_the_same(arm: tuple[DHChain, Program], least: int) -> None:
    dh, before = arm
    after = with_shared_branches(before, least)
    assert before != after
    rng = np.random.default_rng(5)
    special = rng.integers(-2, 3, (30, dh.dof)) * (math.pi / 2)
    q = np.concatenate([rng.uniform(-math.pi, math.pi, (30, dh.dof)), special])
    for pose in dh_pose(dh, q):
        given = {f"t{i}{j}": float(pose[i, j]) for i in range(3) for j in range(4)}
        given |= {SeedValue(j).name: 0.3 for j in range(dh.dof)}
        old, new = run(before, given), run(after, given)
        assert [one.singular for one in old] == [one.singular for one in new]
        for one, other in zip(old, new, strict=True):
            gap = np.subtract(one.q, other.q)
            assert np.abs((gap + math.pi) % (2 * math.pi) - math.pi).max() < 1e-15


def test_of_a_spherical_wrist_only_the_flip_is_left() -> None:
    found = with_shared_branches(lower(solve_chain(SPHERICAL_WRIST)))
    flips = body(found, len(found.levels) - 1)
    assert found.levels[-1].branches == 2 and {"q4", "q5", "q6"} <= flips.keys()
    assert set().union(*map(operations, flips.values())) <= {"select", "gt"}
    # the two settings of a wrist are half a turn apart
    assert found.levels[-1].solved == ()


def test_what_moves_takes_its_heading_along(arm: tuple[DHChain, Program]) -> None:
    found = with_shared_branches(arm[1])
    told = [[s.text for s in lv.body if isinstance(s, Comment)] for lv in found.levels]
    before = [s.text for lv in arm[1].levels for s in lv.body if isinstance(s, Comment)]
    assert {text for level in told for text in level} == set(before)
    assert sum(map(len, told)) > len(before)
    for level in told:
        assert len(level) == len(set(level))


def test_levels_of_few_rows_stay_as_they_are(arm: tuple[DHChain, Program]) -> None:
    before = arm[1]
    found = with_shared_branches(before, before.max_solutions)
    assert len(before.levels) > 2
    for index, (level, old) in enumerate(zip(found.levels[:-1], before.levels, strict=False)):
        now = body(found, index)
        assert all(now.get(s.name, s.value) == s.value for s in old.body if isinstance(s, Let))
        guards = [s for s in old.body if isinstance(s, Require)]
        assert [s for s in level.body if isinstance(s, Require) and s in old.body] == guards
    assert with_shared_branches(before, 2 * before.max_solutions) is before


# -- operations -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("value", "even", "odd"),
    [
        (op("mul", "s", "s"), True, False),
        (op("div", "t01", "s"), False, True),
        (op("add", "s", op("mul", 2.0, "s")), False, True),
        (op("sub", "s", "t01"), False, False),
        (op("neg", "s"), False, True),
        (op("abs", "s"), True, False),
        (op("cos", "s"), True, False),
        (op("sin", "s"), False, True),
        (op("max", "s", 0.0), False, False),
        (op("sqrt", op("mul", "s", "s")), True, False),
    ],
)  # fmt: skip
def test_even_values_move_and_odd_ones_leave_their_sign(
    value: Operand, even: bool, odd: bool
) -> None:
    written = program((), (Let("s", op("mul", "sigma_1", "t00")), Let("out", value)))
    found = with_shared_branches(written)
    assert ("out" in body(found, 0)) == even
    assert (body(found, 1).get("out") == op("mul", "sigma_1", "out_plus")) == odd
    assert "sigma_1" not in set().union(*map(operand_names, body(found, 0).values()))
    assert rows(found, 0.7, 0.4) == rows(written, 0.7, 0.4)


@pytest.mark.parametrize(
    ("sine", "cosine"),
    [("s", "c"), ("s", "t01"), ("t00", "c")],
    ids=["half a turn apart", "mirrored at the first axis", "mirrored at the second"],
)
@pytest.mark.parametrize("y", [0.6, 0.0, -0.6])
@pytest.mark.parametrize("x", [0.8, -0.8])
def test_an_angle_is_taken_once(sine: str, cosine: str, y: float, x: float) -> None:
    pair = (Let("s", op("mul", "sigma_1", "t00")), Let("c", op("mul", "sigma_1", "t01")))
    written = program((), (*pair, Let("out", op("atan2", sine, cosine))))
    found = with_shared_branches(written)
    assert "atan2" not in operations(body(found, 1)["out"])
    for one, other in zip(rows(found, y, x), rows(written, y, x), strict=True):
        assert -math.pi < one.q[0] <= math.pi
        assert abs(math.remainder(one.q[0] - other.q[0], 2 * math.pi)) < 1e-15


def test_a_choice_of_signs_is_a_sign() -> None:
    far = op("gt", "t01", 0.0)
    chosen = op("select", "far", op("mul", "sigma_1", "t00"), "t01")
    lets = (Let("out", chosen), Let("square_out", op("mul", "out", "out")))
    written = program((Let("far", far, True),), lets)
    found = with_shared_branches(written)
    assert "square_out" in body(found, 0)
    assert op("select", "far", "sigma_1", 1.0) in body(found, 1).values()
    for t01 in (0.4, -0.4):
        assert rows(found, 0.7, t01) == rows(written, 0.7, t01)


def test_signs_of_each_level_are_drawn_out_one_after_the_other() -> None:
    s, both = op("mul", "sigma_1", "t00"), op("mul", "sigma_2", op("add", "s", "s"))
    written = program((), (Let("s", s),), (Let("out", op("mul", both, both)),))
    found = with_shared_branches(written)
    assert not body(found, 1) and not body(found, 2)
    assert rows(found, 0.7, 0.4) == rows(written, 0.7, 0.4)


def test_a_guard_that_both_branches_share_is_asked_once() -> None:
    s = Let("s", op("mul", "sigma_1", "t00"))
    shared = Require(op("gt", 1.0, op("mul", "s", "s")), fold=True)
    own = Require(op("gt", "s", -2.0))
    found = with_shared_branches(program((), (s, shared, own, Let("out", "s"))))
    assert [type(one) for one in found.levels[0].body] == [Require]
    assert found.levels[0].body[0] == Require(op("gt", 1.0, op("mul", "t00", "t00")), fold=True)
    assert [one for one in found.levels[1].body if isinstance(one, Require)] == [own]
    assert rows(found, 1.5, 0.0) == [] and len(rows(found, 0.5, 0.0)) == 2


@pytest.mark.parametrize(
    ("cosine", "left"),
    [(op("mul", "sigma_1", "t01"), ()), (op("add", "t01", 0.0), ("c1", "s1"))],
    ids=["half a turn apart", "mirrored"],
)
def test_branches_half_a_turn_apart_never_meet(cosine: Operand, left: tuple[str, ...]) -> None:
    pair = (Let("c1", cosine), Let("s1", op("mul", "sigma_1", "t00")))
    out = Let("out", op("add", "c1", "s1"))
    assert (
        with_shared_branches(program((), (*pair, out), solved=("c1", "s1"))).levels[1].solved
        == left
    )


def test_a_slide_s_branches_meet_at_zero() -> None:
    written = program(
        (), (Let("d1", op("mul", "sigma_1", "t00")), Let("out", "d1")), solved=("d1",)
    )
    found = with_shared_branches(written)
    assert found.levels[1].solved == ("d1",) and "d1" in body(found, 1)


def test_roots_of_a_routine_stay_where_they_are() -> None:
    written = program((), (Let("out", op("mul", "u", "u")),))
    call = Level(2, None, Call(TRIG_QUARTIC, ("t00",), ("u",)), written.levels[1].body)
    both = Level(2, "sigma_1", None, (Let("s", op("mul", "sigma_1", "u")),))
    routine = replace(written, levels=(written.levels[0], call, both))
    assert body(with_shared_branches(routine), 1) == {"out": op("mul", "u", "u")}
    no_sign = replace(written, levels=(written.levels[0], call))
    assert with_shared_branches(no_sign) is no_sign


def test_flags_are_told_where_they_are_known() -> None:
    s = Let("s", op("mul", "sigma_1", "t00"))
    flag = Let("flag", op("gt", 0.1, op("abs", "s")), True)
    written = program((), (s, flag, Let("out", "s")), singular=("flag",), residuals=("flag",))
    found = with_shared_branches(written)
    assert "flag" in body(found, 0)
    for t00 in (0.05, 0.5):
        assert rows(found, t00, 0.0) == rows(written, t00, 0.0)


# -- any Program ----------------------------------------------------------------------------------

LEAVES = st.sampled_from(["t00", "t01", "sigma_1", "sigma_2", "a", "b"]) | st.sampled_from(
    [2.0, 0.5]
)


def _larger(inner: st.SearchStrategy[Operand]) -> st.SearchStrategy[Operand]:
    two = ["add", "sub", "mul", "max", "min"]
    over = st.builds(lambda a, b: op("div", a, op("add", 3.0, op("abs", b))), inner, inner)
    chosen = st.builds(lambda a, b, c, d: op("select", op("gt", a, b), c, d), *[inner] * 4)
    return (
        st.builds(lambda o, a, b: op(o, a, b), st.sampled_from(two), inner, inner)
        | st.builds(
            lambda o, a: op(o, a), st.sampled_from(["neg", "abs", "sqrt", "cos", "sin"]), inner
        )
        | over
        | chosen
    )


OPERANDS = st.recursive(LEAVES, _larger, max_leaves=8)
NUMBERS = st.sampled_from([-1.5, -0.25, 0.75, 1.25])


def _without(operand: Operand, *names: str) -> Operand:
    """The operand of a level outside, which has not these names."""
    if isinstance(operand, Op):
        return Op(operand.op, tuple(_without(a, *names) for a in operand.args))
    return 1.5 if operand in names else operand


@given(st.lists(OPERANDS, min_size=6, max_size=6), NUMBERS, NUMBERS)
def test_any_program_gives_the_same_rows(values: list[Operand], t00: float, t01: float) -> None:
    a, a_out, guard, b, b_out, last = values
    first = _without(a, "sigma_2", "a", "b")
    outside = [_without(one, "sigma_2", "b") for one in (a_out, guard)]
    outer = (Let("a", first), Let("a_out", outside[0]), Require(op("gt", outside[1], -0.3)))
    inner = (Let("b", _without(b, "b")), Let("b_out", b_out), Let("c_out", last))
    written = program((), outer, (*inner, Require(op("gt", last, -2.0))))
    assert rows(with_shared_branches(written), t00, t01) == rows(written, t00, t01)
