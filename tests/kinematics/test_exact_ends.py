"""Tools and bases that a file rounds, for tasks that read a part of the pose."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tests.support.chains import chain_forward
from tests.support.redundant_arms import Joint, serial_urdf
from tests.support.sampled import sampled

from ikgen.derivation.derive import derive
from ikgen.generation.generate import generate
from ikgen.kinematics.exact_ends import with_exact_ends
from ikgen.kinematics.forward import dh_forward, file_forward
from ikgen.kinematics.modified_dh import to_dh
from ikgen.records.request import Outputs, Request

pytestmark = pytest.mark.usefixtures("solved_once")

_TURN = (-2.9, 2.9)
FIVE: tuple[Joint, ...] = (
    ("pan", "revolute", "0 0 1", "0 0 0.1", _TURN),
    ("lift", "revolute", "0 1 0", "0.03 0 0.05", (-2.0, 2.0)),
    ("elbow", "revolute", "0 1 0", "0 0 0.12", (-2.0, 2.0)),
    ("wrist", "revolute", "0 1 0", "0 0 0.13", (-2.0, 2.0)),
    ("roll", "revolute", "0 0 1", "0.02 0 0.06", _TURN),
)
"""Three parallel joints after a pan, the tool beyond a roll beside them."""


def five(folder: Path, half_turn: str, task: str | None = "position-direction") -> Request:
    """The arm with a tool that is turned by half a turn, in as many digits."""
    text = serial_urdf("five", FIVE)
    plain = '<origin xyz="0 0 0.1" rpy="0 0 0"/><axis xyz="0 0 1"/><limit lower="0.0"'
    assert plain in text
    turned = plain.replace('0 0 0.1" rpy="0 0 0', f'0.03 0 0.1" rpy="{half_turn} 0 0')
    path = folder / f"five_{len(half_turn)}.urdf"
    path.write_text(text.replace(plain, turned))
    return Request(path, task=task)


@pytest.mark.parametrize("half_turn", sampled(["3.1416", "3.14159", "3.14159265"], ["3.14159"]))
def test_rounded_tool_has_the_closed_form_of_the_exact_one(tmp_path: Path, half_turn: str) -> None:
    meant = derive(five(tmp_path, "3.141592653589793"))
    found = derive(five(tmp_path, half_turn))
    assert found.graph.order == meant.graph.order
    assert found.module.program.max_solutions == meant.module.program.max_solutions
    assert all(step.branches <= 2 for step in found.graph.steps)
    dh = found.reading.dh
    if len(half_turn) < 10:
        assert "turn of the tool" in [snap.what for snap in dh.snaps]
        assert 1e-7 < dh.deviation[1] < 1e-4
    q = np.random.default_rng(1).uniform(-2, 2, (20, 5))
    assert found.reading.chain is not None
    expected = chain_forward(found.reading.chain, q)
    np.testing.assert_allclose(file_forward(dh, q), expected, atol=1e-14, rtol=0)


def test_rounded_tool_is_solved_and_verified(tmp_path: Path) -> None:
    made = generate(five(tmp_path, "3.14159"), Outputs(out=tmp_path / "out", samples=40))
    assert made.reports["python"].passed


def test_ends_that_mean_what_they_say_stay(tmp_path: Path) -> None:
    reading = derive(five(tmp_path, "3.141592653589793")).reading
    assert reading.chain is not None
    dh = to_dh(reading.chain)
    assert with_exact_ends(dh) is dh
    general = derive(five(tmp_path, "2.2")).reading.dh
    assert with_exact_ends(general) is general


def test_short_offset_of_the_tool_counts_as_none(tmp_path: Path) -> None:
    reading = derive(five(tmp_path, "3.141592653589793")).reading
    assert reading.chain is not None
    dh = to_dh(reading.chain)
    X_tip = dh.X_tip.copy()
    X_tip[1, 3] += 4e-6
    off = replace(dh, X_tip=X_tip, file_frames=(*dh.file_frames[:-1], X_tip))
    exact = with_exact_ends(off)
    np.testing.assert_array_equal(exact.X_tip, dh.X_tip)
    assert exact.deviation[0] == pytest.approx(4e-6, rel=1e-6)
    q = np.full(5, 0.3)
    assert np.abs(dh_forward(exact, q) - file_forward(off, q)).max() > 1e-6
