"""Headers of arms that an elimination solves: which one, and the numbers that a row has of it."""

from __future__ import annotations

import pytest
from tests.support.tables import Row, table

from ikgen.elimination import EliminationPlan
from ikgen.elimination.loop_frames import held_frames, typical_length
from ikgen.emit.cpp.cpp_emitter import emit_header
from ikgen.emit.solver_module import SolverModule
from ikgen.lowering.elimination_program import elimination_program

TURNS: tuple[Row, ...] = (
    ("R", "0", 0.1, 0.2), ("R", "1", 0.3, 0.1), ("R", "-1", 0.2, 0.0), ("R", "1", 0.1, 0.3),
    ("R", "-1", 0.2, 0.1), ("R", "1", 0.1, 0.1),
)  # fmt: skip


@pytest.mark.parametrize(("slide", "name"), [(None, "General6r"), (2, "OneSlide")])
def test_the_elimination_is_named(slide: int | None, name: str) -> None:
    rows = [("P" if k == slide else kind, *rest) for k, (kind, *rest) in enumerate(TURNS)]
    dh = table(*rows)
    frames, turning = held_frames(dh), tuple(k != slide for k in range(6))
    length = typical_length(frames, turning)
    resultants = ((0, 0),) if slide is None else ()
    plan = EliminationPlan(frames, length, ((1, 0, 0),), 1.0, resultants, turning)
    module = SolverModule(
        name="arm", program=elimination_program(dh, 16), dh=dh, task="pose", free=(), free_defaults=(),
        source_name="arm.toml", source_sha256="0" * 64, generator_version="test", plan=plan,
    )  # fmt: skip
    text = emit_header(module)
    assert text.count(f"  return {name}<Arm>::branches(") == 1
