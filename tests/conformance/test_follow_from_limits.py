"""Paths from a stretched knee on its limit: of the two branches that meet there one is inside."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.both_languages import in_both
from tests.support.serial_urdf import serial_urdf
from tests.support.solving import NO_COMPILER, import_text

from ikgen.derivation.derive import derive
from ikgen.emit.derivation import Derivation
from ikgen.emit.python.python_emitter import emit_module
from ikgen.records.request import Request

pytestmark = pytest.mark.usefixtures("solved_once")

LEG = [
    ("0 0.09 -0.15", "0 0 0"), ("0 0 0", "0 0 0"), ("0 0.03 0", "0 0 0"), ("0 0 -0.4", "0 0 0"),
    ("0 0 -0.38", "0 0 0"), ("0 0 0", "0 0 0"),
]  # fmt: skip
RANGES = [(-1.0, 1.0), (-0.6, 0.6), (-1.6, 0.3), (0.0, 2.5), (-1.4, 0.3), (-0.6, 0.6)]
LOW, HIGH = np.array(RANGES).T


def leg(folder: Path) -> Derivation:
    axes = ["0 0 1", "1 0 0", "0 1 0", "0 1 0", "0 1 0", "1 0 0"]
    return derive(Request(serial_urdf(folder / "leg.urdf", LEG, axes=axes, limit=RANGES)))


def ways(count: int) -> list[NDArray[np.float64]]:
    """Straight ways (30, 6) of the joints from a stretched knee, of two of three also from a limit of
    another joint, which they leave or stay on."""
    random, out = np.random.default_rng(2), []
    for k in range(count):
        start = random.uniform(0.8 * LOW, 0.8 * HIGH)
        start[3] = 0.0
        if k % 3:
            start[2 * (k % 3)] = RANGES[2 * (k % 3)][k % 2]
        end = np.clip(start + 0.3 * random.normal(size=6), LOW, HIGH)
        end[3] = random.uniform(0.02, 0.4)
        out.append(start + np.linspace(0.0, 1.0, 30)[:, None] * (end - start))
    return out


def test_paths_go_on_from_a_stretched_knee(tmp_path: Path) -> None:
    arm = import_text(emit_module(leg(tmp_path).module), tmp_path)
    for q in ways(24):
        path = arm.follow(arm.forward(q), start=q[0])
        assert path.status is arm.Status.OK, (path.reached, path.status, q[[0, -1]].tolist())
        assert np.abs(path.q - q).max() < 1e-6


@pytest.mark.long
@pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER or "compiles")
def test_paths_go_on_from_a_stretched_knee_in_cpp(tmp_path: Path) -> None:
    both = in_both(leg(tmp_path).module, tmp_path, "4")
    for q in ways(24):
        status, _, rows = both.follow(q[0], both.arm.forward(q))
        assert status == "OK" and np.abs(rows - q).max() < 1e-6, q[[0, -1]].tolist()
