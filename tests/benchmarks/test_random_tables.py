"""Random tables: of the class that was asked for, and the same chain as a file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from benchmarks.random_tables import Drawn, pattern, random_table, table_text

from ikgen.derivation.read import read
from ikgen.equations.probes import dh_pose
from ikgen.records.request import Request


@pytest.mark.parametrize("slides", [1, 2, 3])
@pytest.mark.parametrize("any_angle", [False, True])
def test_a_drawn_class_is_what_the_file_says(slides: int, any_angle: bool, tmp_path: Path) -> None:
    dh = random_table(np.random.default_rng(slides), Drawn(6, 6, slides, any_angle))
    path = tmp_path / "drawn.toml"
    path.write_text(table_text(dh, "drawn"))
    again = read(Request(robot=path)).dh
    assert pattern(dh).count("P") == slides and ("/" in pattern(dh)) == any_angle
    q = np.random.default_rng(0).uniform(-2.0, 2.0, (5, 6))
    assert np.abs(dh_pose(dh, q) - dh_pose(again, q)).max() < 1e-9
    assert [row.revolute for row in again.rows] == [row.revolute for row in dh.rows]
