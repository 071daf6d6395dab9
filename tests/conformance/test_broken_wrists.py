"""Wrists whose axes miss each other by a fraction of a millimetre: beside their singularity two further
solutions lie between those of the closed form."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.support.both_languages import emitted_in_both
from tests.support.serial_urdf import serial_urdf
from tests.support.solving import NO_COMPILER

from ikgen.generation.request import Request

pytestmark = pytest.mark.usefixtures("solved_once")

ORIGINS = (
    ("0 0 0.003445", "3.141592653589793 0 0"),
    ("0 0.064146 -0.16608", "1.5708 0.5236 -1.5708"),
    ("0.1525 -0.26414 0", "0 0 -1.04720367321"),
    ("0 0 0.00675", "1.5708 -1.2554 -1.5708"),
    ("0 0 -0.22225", "3.141592653589793 0 -2.8262"),
    ("-0.000294 0 0.02117", "0 0 3.1416"),
)
AXES = ("0 0 1", "0 0 -1", "0 0 -1", "0 0 -1", "1 0 0", "0 0 1")
BETWEEN = np.array(
    [
        [2.0905339814, 1.4146526577, 1.5518611857, 1.4529094216, -0.0000451587, -0.0869394404],
        [1.8481867791, 1.4258924478, 1.6305770628, 1.5552706805, 0.0, -2.1846441479],
        [0.7853865857, 1.5706230436, 1.5705413890, 1.5706824432, -0.0001946026, -0.3245948452],
        [-1.4419767272, 1.4931770810, 1.4805707040, 1.6993919416, -0.0000024164, -1.5608902723],
        [2.6172615985, 1.4646689679, 1.5958569706, 1.7177986402, 0.0001266857, 0.3887287303],
    ]
)


@pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER or "compiles")
def test_solutions_between_those_of_the_closed_form_are_found(tmp_path: Path) -> None:
    path = serial_urdf(tmp_path / "wrist.urdf", ORIGINS, axes=AXES, limit=3.1)
    arm, header = emitted_in_both(Request(path, name="wrist"), tmp_path)
    random = np.random.default_rng(1)
    q = BETWEEN[random.integers(len(BETWEEN), size=400)]
    q = q + random.normal(size=q.shape) * 10.0 ** random.uniform(-7, -5, (400, 1))
    poses = arm.forward(q)
    batch, _, _ = arm.solve_batch(poses)
    for found in (header.solve_many(poses).q, batch):
        off = np.abs((found - q[:, None] + np.pi) % (2.0 * np.pi) - np.pi).max(axis=2)
        assert np.where(np.isnan(off), np.inf, off).min(axis=1).max() < 1e-3
