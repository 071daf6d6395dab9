"""Code of arms that an elimination solves: which one a header names, rows of a module's batches."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.support.module_facts import module_around
from tests.support.solving import import_text
from tests.support.tables import Row, table

from ikgen.elimination import EliminationPlan
from ikgen.elimination.loop_frames import held_frames, typical_length
from ikgen.emit.cpp.cpp_emitter import emit_header
from ikgen.emit.python.python_emitter import emit_module
from ikgen.emit.solver_module import SolverModule
from ikgen.lowering.elimination_program import elimination_program

TURNS: tuple[Row, ...] = (
    ("R", "0", 0.1, 0.2), ("R", "1", 0.3, 0.1), ("R", "-1", 0.2, 0.0), ("R", "1", 0.1, 0.3),
    ("R", "-1", 0.2, 0.1), ("R", "1", 0.1, 0.1),
)  # fmt: skip


def solver_module(slide: int | None, *, both: bool = False) -> SolverModule:
    """Of a general arm whose joint `slide` (from 0) slides."""
    rows = [("P" if k == slide else kind, *rest) for k, (kind, *rest) in enumerate(TURNS)]
    dh = table(*rows)
    frames, turning = held_frames(dh), tuple(k != slide for k in range(6))
    length = typical_length(frames, turning)
    resultants = ((0, 0),) if slide is None else ()
    plan = EliminationPlan(frames, length, ((1, 0, 0),), 1.0, resultants, turning, both=both)
    program = elimination_program(dh, plan.routine, 16)
    return module_around(program, dh, plan=plan)


@pytest.mark.parametrize(
    ("slide", "both", "name"),
    [(None, False, "General6r"), (2, False, "OneSlide"), (2, True, "OneSlideBoth")],
)
def test_the_elimination_is_named(slide: int | None, both: bool, name: str) -> None:
    text = emit_header(solver_module(slide, both=both))
    assert text.count(f"  return {name}<Arm>::branches(") == 1


def test_poses_of_a_batch_have_rows_where_they_are_reached(tmp_path: Path) -> None:
    arm = import_text(emit_module(solver_module(None)), tmp_path)
    q = np.random.default_rng(1).uniform(-2.0, 2.0, (6, 6))
    poses = arm.forward(q)
    poses[::2, :3, 3] += 50.0
    rows, count, _ = arm.solve_batch(poses)
    assert (count[::2] == 0).all() and (count[1::2] > 0).all()
    for at, found, n in zip(q[1::2], rows[1::2], count[1::2], strict=True):
        apart = np.abs(np.remainder(found[:n] - at + np.pi, 2.0 * np.pi) - np.pi)
        assert apart.max(axis=1).min() < 1e-6
    for pose, n in zip(poses, count, strict=True):
        assert len(arm.solve(pose)) == n
