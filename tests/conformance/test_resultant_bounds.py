"""Double roots of an elimination, which rounding lifts over the bound of what it may amount to."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.support.both_languages import emitted_in_both
from tests.support.row_gaps import row_gaps
from tests.support.serial_urdf import serial_urdf
from tests.support.solving import NO_COMPILER

from ikgen.records.request import Request

pytestmark = pytest.mark.usefixtures("solved_once")

ORIGINS = (  # of a humanoid's arm, to its forearm
    ("-0.154 -0.0825 -0.0005", "1.5708 0 -1.0472"),
    ("0 0.025 0.1213", "-1.5708 1.0472 0.024932"),
    ("0 0.135 -0.037", "-1.5708 0 -3.1416"),
    ("0.02 0 -0.225", "-1.5708 -1.5707963267948966 -1.5708"),
    ("-0.09 0 -0.0155", "0 0 -3.1416"),
    ("0.175 0 -0.002", "-1.5708 -1.5708 0"),
)
AXES = ("0 0 1", "0 0 1", "0 0 1", "0 0 1", "1 0 0", "1 0 0")
FOLDS = np.array(  # where two solutions are one, whatever the first joint and the last one
    [
        [2.0925918389886737, -0.6080140846833236, -0.552663638110664, -0.4625754788226381],
        [2.0928591530936975, 0.235502426431201, -1.0090215793007653, -0.9883422489304454],
        [2.0918790935719787, -0.5617340718922008, 1.1762063188893419, 1.3413906373572466],
        [2.093214467303659, -0.837131165640025, -0.9154454392507284, 1.165404254370783],
        [2.0931146807214391, 0.883747514111721, -1.0260940854259337, -1.1480235519472284],
    ]
)


@pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER or "compiles")
@pytest.mark.long
def test_they_are_found_where_products_are_fused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("ikgen.verify.runners.cpp_header.LIGHT", ("-O1", "-march=native"))
    path = serial_urdf(tmp_path / "forearm.urdf", ORIGINS, axes=AXES, limit=3.1)
    arm, header = emitted_in_both(Request(path, name="forearm"), tmp_path)
    random = np.random.default_rng(1)
    q = random.uniform(-3.0, 3.0, (500, 6))
    q[:, 1:5] = np.repeat(FOLDS, 100, axis=0)
    assert row_gaps(header.solve_many(arm.forward(q)).q, q).max() < 1e-4
