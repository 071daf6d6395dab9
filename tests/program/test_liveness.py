"""What a Program's results depend on; trimming leaves the rows as they are."""

from __future__ import annotations

from dataclasses import replace

import pytest
from tests.support.tables import table

from ikgen.lowering.lower import lower
from ikgen.program.inputs import HeldValue, PoseEntry, SeedValue
from ikgen.program.interpret import run
from ikgen.program.liveness import live_names, trimmed
from ikgen.program.ops import Op
from ikgen.program.routines import TRIG_QUARTIC
from ikgen.program.statements import Call, JointOutput, Let, Level, Program, Require
from ikgen.solver.solve import solve_chain

CALL = Call(TRIG_QUARTIC, ("given",), ("u",))
PROGRAM = Program(
    name="p",
    parameters=(),
    constants=(Let("k1", 2.0), Let("k2", 3.0)),
    inputs=(PoseEntry(0, 3), PoseEntry(1, 3), SeedValue(0), SeedValue(1), HeldValue(2)),
    prelude=(
        Let("given", "seed_q1"),
        Let("step", Op("neg", ("seed_q2",))),
        Let("idle", Op("add", ("step", 1.0))),
    ),
    levels=(
        Level(1, None, None, (Let("x", Op("add", ("t03", "k1"))),)),
        Level(2, None, CALL, (Let("f", Op("gt", ("u", 0.0))), Require(Op("gt", ("x", 0.0))))),
    ),
    outputs=(JointOutput(0, Op("mul", ("u", 2.0))),),
    singular=("f",),
)


def test_results_guards_flags_and_arguments_are_live() -> None:
    assert live_names(PROGRAM) == {"u", "f", "x", "t03", "k1", "given", "seed_q1"}


@pytest.mark.parametrize(
    ("change", "live"),
    [
        ({"residuals": ("t13",)}, {"t13"}),
        ({"outputs": (JointOutput(0, "idle"),)}, {"idle", "step", "seed_q2"}),
        ({"outputs": (JointOutput(0, Op("mul", ("k2", "held_q3"))),)}, {"k2", "held_q3"}),
    ],
)
def test_what_more_is_read_is_live_too(change: dict[str, object], live: set[str]) -> None:
    assert live_names(replace(PROGRAM, **change)) - live_names(PROGRAM) == live


def test_trimming_drops_inputs_and_values_that_nothing_reads() -> None:
    found = trimmed(PROGRAM)
    assert found.inputs == (PoseEntry(0, 3), SeedValue(0))
    assert found.prelude == (Let("given", "seed_q1"),)
    assert found == replace(PROGRAM, inputs=found.inputs, prelude=found.prelude)
    assert trimmed(found) == found


def test_a_trimmed_program_gives_the_same_rows() -> None:
    def roots(given: float) -> list[tuple[float, ...]]:
        return [(given,), (-given,)]

    inputs = {"t03": 0.5, "t13": 0.1, "seed_q1": 0.3, "seed_q2": 0.2, "held_q3": 0.1}
    full = run(PROGRAM, inputs, {TRIG_QUARTIC.name: roots})
    found = trimmed(PROGRAM)
    few = {one.name: inputs[one.name] for one in found.inputs}
    assert len(full) == 2 and run(found, few, {TRIG_QUARTIC.name: roots}) == full


def test_lowered_programs_are_trimmed() -> None:
    dh = table(("R", "0", 0.0, 0.0), ("R", "0", 0.5, 0.0), ("R", "0", 0.4, 0.0))
    program = lower(solve_chain(dh))
    assert trimmed(program) == program
    held = replace(dh, free=("q2",))
    program = lower(solve_chain(held, readable=frozenset({"px", "py"})))
    assert trimmed(program) == program
    assert program.inputs_of(HeldValue) == (HeldValue(2),)
    assert {(e.row, e.column) for e in program.inputs_of(PoseEntry)} == {(0, 3), (1, 3)}
