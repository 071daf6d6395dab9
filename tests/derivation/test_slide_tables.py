"""Tables of six joints with slides that rules leave open, from the file to the emitted solver."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.support.dh_files import dh_file
from tests.support.solving import import_text

from ikgen.derivation.derive import derive
from ikgen.emit.cpp.cpp_emitter import emit_header
from ikgen.emit.python.python_emitter import emit_module
from ikgen.records.request import Request

ANGLES = (0.3, 1.2, -0.7, 0.9, -1.1, 0.6)


def table(kinds: str, folder: Path) -> Path:
    """A table of up to six joints without special geometry."""
    rows = [
        ("revolute" if kind == "R" else "prismatic", twist, 0.1 * (i % 3) + 0.07, 0.2 - 0.06 * i, 0)
        for i, (kind, twist) in enumerate(zip(kinds, ANGLES, strict=False))
    ]
    return dh_file(folder / f"{kinds.lower()}.toml", rows)


@pytest.mark.parametrize(
    ("kinds", "most", "name"),
    [("RRRPRR", 16, "5R1P"), ("RPRRPR", 8, "4R2P"), ("RPRPRP", 2, "3R3P")],
)
def test_what_rules_leave_open_is_eliminated(
    kinds: str, most: int, name: str, tmp_path: Path
) -> None:
    found = derive(Request(robot=table(kinds, tmp_path)))
    assert found.module.max_solutions == most
    assert found.module.order == (f"all joints ({name} elimination)",)
    assert "_branches(const double* x" in emit_header(found.module)
    module = import_text(emit_module(found.module), tmp_path)
    rng = np.random.default_rng(1)
    q = rng.uniform(-1.0, 1.0, (20, 6))
    q = q[np.linalg.svd(module.jacobian(q), compute_uv=False)[:, -1] > 1e-2]
    rows, count, status = module.solve_batch(module.forward(q), limits=False)
    assert len(q) > 10 and set(status.tolist()) == {"OK"}
    for at, found_rows, n in zip(q, rows, count, strict=True):
        assert np.abs(found_rows[:n] - at).max(axis=1).min() < 1e-7
        pose = module.forward(at)
        assert np.abs(module.forward(found_rows[:n]) - pose).max() < 1e-9
        assert len(module.solve(pose, limits=False)) == n
