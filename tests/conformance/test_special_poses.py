"""Tables whose solvers lost solutions where joints lie at multiples of 90 degrees and slides at 0."""

from __future__ import annotations

from math import pi
from pathlib import Path

import numpy as np
import pytest
from tests.support.solving import import_text

from ikgen.emit.python.python_emitter import emit_module
from ikgen.generation.derive import derive
from ikgen.generation.request import Request

# kind, alpha (quarters), a, d of each row; joint values
SLIDE = (
    [
        ("revolute", 0, 0.0, 0.44),
        ("revolute", -1, 0.0, 0.0),
        ("prismatic", 0, 0.0, 0.0),
        ("revolute", -1, 0.74, 0.0),
        ("revolute", 1, 0.0, 0.35),
    ],
    [-pi, -pi / 2, 0.0, 0.1546173992229667, pi],
)
FOLDS = (
    [
        ("revolute", 0, 0.0, 0.851283243473224),
        ("revolute", -1, 0.2627114187209788, 0.0),
        ("revolute", 0, 0.7344616072714591, 0.0),
        ("revolute", 1, 0.0, 0.0),
        ("revolute", 0, 0.5723887521825102, 0.0),
    ],
    [0.0, 1.5094153249861169, pi / 2, -pi, pi],
)

QUARTICS = (
    [
        ("revolute", 0, 0.0, 0.0),
        ("revolute", 0, 0.3084523523618435, 0.615170442483001),
        ("revolute", -1, 0.4145408166397275, 0.0),
        ("revolute", -1, 0.3181643724869212, 0.0),
        ("revolute", -1, 0.5746268653713172, 0.0),
    ],
    [pi, -pi, pi / 2, -0.43461341559486044, 0.13840886864980817],
)
BEHIND_A_QUARTIC = (
    [
        ("prismatic", 0, 0.0, 0.0),
        ("revolute", 0, 0.0, 0.0),
        ("revolute", -1, 0.0, 0.0),
        ("revolute", 1, 0.44708589017540884, 0.0),
        ("revolute", -1, 0.905045738190152, 0.0),
    ],
    [-0.7296057862685923, 0.4262236538833992, -pi / 2, 2.081041988664359, -pi / 2],
)
SPECIAL = {
    "slide at 0": SLIDE,
    "fold behind a fold": FOLDS,
    "quartic behind a quartic": QUARTICS,
    "fold behind a quartic": BEHIND_A_QUARTIC,
}


def table(rows: list[tuple[str, int, float, float]], folder: Path) -> Path:
    text = 'name = "special"\nconvention = "modified"\n'
    for kind, quarters, a, d in rows:
        text += (
            f'[[joints]]\ntype = "{kind}"\nalpha = "{quarters}*pi/2"\na = {a}\nd = {d}\ntheta = 0\n'
        )
    path = folder / "special.toml"
    path.write_text(text)
    return path


@pytest.mark.parametrize(("rows", "q"), SPECIAL.values(), ids=SPECIAL)
def test_the_generating_configuration_is_found(
    rows: list[tuple[str, int, float, float]], q: list[float], tmp_path: Path
) -> None:
    module = derive(Request(table(rows, tmp_path), task="pose")).module
    arm = import_text(emit_module(module), tmp_path)
    found = arm.solve(arm.forward(q), limits=False)
    apart = np.abs((found.q - q + pi) % (2 * pi) - pi).max(axis=1, initial=0.0)
    assert len(found) and apart.min() < 1e-5
    assert np.abs(arm.forward(found.q) - arm.forward(q)).max() < 1e-9
