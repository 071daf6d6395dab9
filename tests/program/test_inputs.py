"""Inputs by kind, each with a name of its own."""

from __future__ import annotations

import itertools

from tests.support.tables import table

from ikgen.lowering.lower import lower
from ikgen.program.inputs import HeldValue, PoseEntry, SeedValue
from ikgen.solver.solve import solve_chain


def test_names_count_entries_from_zero_and_joints_from_one() -> None:
    assert PoseEntry(0, 3).name == "t03"
    assert SeedValue(0).name == "seed_q1"
    assert HeldValue(6).name == "held_q7"


def test_no_two_inputs_share_a_name() -> None:
    inputs = [
        *(PoseEntry(i, j) for i, j in itertools.product(range(3), range(4))),
        *(kind(j) for kind in (SeedValue, HeldValue) for j in range(12)),
    ]
    assert len({one.name for one in inputs}) == len(set(inputs)) == len(inputs)


def test_inputs_are_found_by_kind_in_order() -> None:
    dh = table(("R", "0", 0.0, 0.2), ("P", "1", 0.3, 0.0), ("R", "1", 0.2, 0.1))
    program = lower(solve_chain(dh))
    entries = program.inputs_of(PoseEntry)
    assert entries and list(entries) == sorted(
        entries, key=lambda e: (e.column == 3, e.row, e.column)
    )
    others = (*program.inputs_of(SeedValue), *program.inputs_of(HeldValue))
    assert {*entries, *others} == set(program.inputs)
