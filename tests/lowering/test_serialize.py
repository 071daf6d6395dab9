"""Programs of whole arms: every name once and before its use, nothing computed twice."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

import numpy as np
import pytest
from tests.support.tables import Row, table

from ikgen.equations.probes import dh_pose
from ikgen.lowering.lower import lower
from ikgen.program.inputs import PoseEntry
from ikgen.program.interpret import run
from ikgen.program.liveness import live_names
from ikgen.program.ops import Op, Operand, operand_names
from ikgen.program.statements import Call, Let, Program, Require
from ikgen.runtime.python.roots.trig_quartic_roots import trig_quartic_branches
from ikgen.solver.solve import solve_chain

ARMS: dict[str, tuple[Row, ...]] = {
    "planar": (("R", "0", 0.0, 0.0), ("R", "0", 0.5, 0.0), ("R", "0", 0.4, 0.0)),
    "sliding": (("R", "0", 0.0, 0.2), ("P", "1", 0.3, 0.0), ("R", "1", 0.2, 0.1)),
    "elbow": (
        ("R", "0", 0.0, 0.3), ("R", "1", 0.1, 0.0), ("R", "0", 0.4, 0.1), ("R", "-1", 0.2, 0.0),
    ),
    "quartic": (
        ("R", "0", 0.0, 0.0), ("R", "-1", 0.3, 0.1), ("R", "1", 0.5, 0.2),
        ("R", "-1", 0.0, 0.4), ("R", "1", 0.0, 0.0), ("R", "-1", 0.0, 0.0),
    ),
}  # fmt: skip


@pytest.fixture(scope="module", params=ARMS)
def arm(request: pytest.FixtureRequest):
    """A chain and its Program."""
    dh = table(*ARMS[request.param])
    return dh, lower(solve_chain(dh))


def operations(operand: Operand) -> Iterator[Op]:
    """An operand's operations, nested ones too."""
    if isinstance(operand, Op):
        yield operand
        for a in operand.args:
            yield from operations(a)


def operands(program: Program) -> Iterator[tuple[str, Operand]]:
    """(name or empty, operand) of every statement in the order that they run; the names that a level
    sets come as operations without arguments."""
    for let in (*program.constants, *program.prelude):
        yield let.name, let.value
    for level in program.levels:
        names = level.call.names if isinstance(level.call, Call) else ()
        for argument in level.call.arguments if level.call else ():
            yield "", argument
        for name in (*names, *([level.sigma] if level.sigma else [])):
            yield name, 0.0
        for statement in level.body:
            if isinstance(statement, Let):
                yield statement.name, statement.value
            elif isinstance(statement, Require):
                yield "", statement.condition
    for operand in (*program.singular, *program.residuals):
        yield "", operand
    for output in program.outputs:
        yield "", output.value


def test_every_name_is_set_once_and_before_it_is_read(arm) -> None:
    _, program = arm
    known = {one.name for one in (*program.parameters, *program.inputs)}
    for name, operand in operands(program):
        assert operand_names(operand) <= known
        if name:
            assert name not in known
            known.add(name)
    assert set(live_names(program)) <= known


def test_nothing_is_computed_twice(arm) -> None:
    _, program = arm
    frames = {one.name for one in program.prelude}  # sums of seed angles are short and named apart
    counts = Counter(
        op
        for name, operand in operands(program)
        if name not in frames
        for op in operations(operand)
    )
    assert counts and counts.most_common(1)[0][1] == 1


def test_constants_read_parameters_alone_and_nothing_else_is_constant(arm) -> None:
    _, program = arm
    fixed = {one.name for one in program.parameters}
    for let in program.constants:
        assert operand_names(let.value) <= fixed
        fixed.add(let.name)
    rest = [pair for pair in operands(program) if pair[0] not in fixed]
    for _, operand in rest:
        for op in operations(operand):
            assert operand_names(op) - fixed


def test_nothing_is_computed_in_a_branch_that_does_not_depend_on_it(arm) -> None:
    _, program = arm
    at: dict[str, int] = {}
    for index, level in enumerate(program.levels):
        for name in level.call.names if level.call else (level.sigma,):
            if name:
                at[name] = index
        for statement in level.body:
            if isinstance(statement, Let | Require):
                value = statement.value if isinstance(statement, Let) else statement.condition
                for op in operations(value):
                    assert max(at.get(name, 0) for name in operand_names(op)) == index
            if isinstance(statement, Let):
                at[statement.name] = index
    assert set(at.values()) == set(range(len(program.levels)))


def test_no_statement_is_idle(arm) -> None:
    _, program = arm
    live = live_names(program)
    assert not [name for name, _ in operands(program) if name and name not in live]


def test_the_rows_hold_the_configuration_that_the_pose_is_from(arm) -> None:
    dh, program = arm
    q = np.random.default_rng(0).uniform(-2.5, 2.5, (40, dh.dof))
    turns = np.array([r.revolute for r in dh.rows])
    for at, T in zip(q, dh_pose(dh, q), strict=True):
        inputs = {e.name: float(T[e.row, e.column]) for e in program.inputs_of(PoseEntry)}
        inputs |= {one.name: 0.0 for one in program.inputs if one.name not in inputs}
        rows = np.array(
            [r.q for r in run(program, inputs, {"trig_quartic": trig_quartic_branches})]
        )
        gap = np.where(turns, np.abs((rows - at + np.pi) % (2 * np.pi) - np.pi), np.abs(rows - at))
        assert gap.max(axis=1).min() < 1e-6
