"""Special and singular poses of the emitted modules: nothing lost, nothing wrong, marked where free."""

from __future__ import annotations

import itertools
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from tests.support.solving import FIXTURES, emitted

from ikgen.chains.selection import select_chain
from ikgen.importers import load_tree
from ikgen.kinematics.modified_dh import to_dh

QUARTERS = (0.0, np.pi / 2, -np.pi / 2, np.pi)


@pytest.fixture(scope="module")
def module(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    folder: Path = tmp_path_factory.mktemp("emitted")
    return emitted(to_dh(select_chain(load_tree(FIXTURES / f"{request.param}.urdf"))), folder)


def _regular(m: ModuleType, q: np.ndarray) -> bool:
    return bool(np.linalg.svd(m.jacobian(q), compute_uv=False)[-1] > 1e-3)


@pytest.mark.parametrize("module", ["kuka_kr6r900sixx", "ur5e", "abb_irb2400"], indirect=True)
def test_right_angles_are_solved_like_any_other(module: ModuleType) -> None:
    rng = np.random.default_rng(0)
    checked = 0
    for joints in itertools.combinations(range(6), 2):
        for values in itertools.product(QUARTERS, repeat=2):
            q = rng.uniform(-2.5, 2.5, 6)
            q[list(joints)] = values
            if not _regular(module, q):
                continue
            rows = module.solve(module.forward(q), limits=False).q
            gap = np.abs((rows - q + np.pi) % (2 * np.pi) - np.pi).max(axis=1)
            assert gap.min() < 1e-6, q
            checked += 1
    assert checked > 100


@pytest.mark.parametrize("module", ["kuka_kr6r900sixx", "ur5e", "abb_irb2400"], indirect=True)
def test_wrist_singularity_returns_marked_rows(module: ModuleType) -> None:
    rng = np.random.default_rng(1)
    for q in rng.uniform(-2.0, 2.0, (20, 6)):
        q[4] = 0.0
        pose = module.forward(q)
        found = module.solve(pose, limits=False, seed=q)
        assert len(found) and found.singular.any()
        assert np.abs(module.forward(found.q) - pose).max() < 1e-9
        gap = np.abs((found.q - q + np.pi) % (2 * np.pi) - np.pi).max(axis=1)
        assert gap.min() < 1e-6


@pytest.mark.parametrize("module", ["kuka_kr6r900sixx", "ur5e", "abb_irb2400"], indirect=True)
def test_all_zero_pose(module: ModuleType) -> None:
    pose = module.forward(np.zeros(6))
    found = module.solve(pose, limits=False)
    assert len(found)
    assert np.abs(module.forward(found.q) - pose).max() < 1e-9


@pytest.mark.parametrize("module", ["kuka_kr6r900sixx", "ur5e"], indirect=True)
def test_eight_solutions(module: ModuleType) -> None:
    rng = np.random.default_rng(2)
    counts = [
        len(module.solve(module.forward(q), limits=False)) for q in rng.uniform(-2, 2, (100, 6))
    ]
    assert max(counts) == module.MAX_SOLUTIONS == 8


@pytest.mark.parametrize("module", ["kuka_kr6r900sixx"], indirect=True)
def test_bad_poses(module: ModuleType) -> None:
    far = np.eye(4)
    far[0, 3] = 50.0
    assert module.solve(far).status is module.Status.UNREACHABLE
    bent = np.eye(4)
    bent[0, 0] = 1.1
    assert module.solve(bent).status is module.Status.INVALID
    assert module.solve(np.full((4, 4), np.nan)).status is module.Status.INVALID
    with pytest.raises(ValueError, match="shape"):
        module.solve(np.eye(3))
