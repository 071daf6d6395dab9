"""Values of rounded constants at the probes."""

from __future__ import annotations

import numpy as np
import pytest
from tests.support.rounded_arms import EXACT, three_parallel

from ikgen.equations.probes import dh_pose, make_probes
from ikgen.kinematics.kept import keep_constants
from ikgen.kinematics.modified_dh import to_dh


def test_exact_rows_have_none() -> None:
    probes = make_probes(to_dh(three_parallel(EXACT)))
    assert not probes.kept


def test_any_value_at_random_probes_and_the_meant_one_at_others() -> None:
    dh = to_dh(three_parallel())
    kept = keep_constants(dh)
    probes = make_probes(kept)
    (values,) = probes.kept.values()
    assert np.abs(values[: probes.generic] - EXACT).min() > 0.1
    np.testing.assert_allclose(values[probes.generic :], EXACT, atol=1e-15)
    np.testing.assert_allclose(probes.pose, dh_pose(kept, probes.values, probes.kept), atol=1e-15)
    meant = dh_pose(kept, probes.values)
    assert meant[probes.generic :] == pytest.approx(probes.pose[probes.generic :], abs=1e-15)
    assert np.abs(meant - probes.pose)[: probes.generic].max() > 0.01
