"""The same arm written differently gives the same solutions."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.chains import chain_forward, rewritten
from tests.support.solving import FIXTURES, emitted

from ikgen.chains.selection import select_chain
from ikgen.importers import load_tree
from ikgen.kinematics.modified_dh import to_dh
from ikgen.model.chain import Chain

ROBOTS = ("kuka_kr6r900sixx", "abb_irb2400", "ur5e", "open_manipulator_x")


def _chain(name: str) -> Chain:
    return select_chain(load_tree(FIXTURES / f"{name}.urdf"))


def _same_sets(a: NDArray[np.float64], b: NDArray[np.float64]) -> bool:
    """Equal up to round-off, which a nearly singular pose magnifies."""
    if len(a) != len(b):
        return False
    gap = np.abs((a[:, None] - b[None] + np.pi) % (2 * np.pi) - np.pi).max(axis=2)
    return bool((gap.min(axis=1) < 1e-5).all() and (gap.min(axis=0) < 1e-5).all())


@pytest.mark.parametrize("name", ROBOTS)
@pytest.mark.parametrize("seed", [0, pytest.param(1, marks=pytest.mark.long)])
def test_other_frames_and_reversed_axes(name: str, seed: int, tmp_path: Path) -> None:
    chain = _chain(name)
    rng = np.random.default_rng(seed)
    other, signs = rewritten(chain, rng)
    first, second = emitted(to_dh(chain), tmp_path), emitted(to_dh(other), tmp_path)
    for q in rng.uniform(-2.0, 2.0, (40, chain.dof)):
        pose = chain_forward(chain, q)
        one = first.solve(pose, limits=False).q
        two = second.solve(pose, limits=False).q * signs
        assert len(one) > 0
        assert _same_sets(one, two)


@pytest.mark.parametrize(
    ("exact", "rounded", "size"),
    [("1.5707963267948966", "1.5708", 3e-4), ("3.141592653589793", "3.14159", 3e-4)],
)
def test_rounded_angles(exact: str, rounded: str, size: float, tmp_path: Path) -> None:
    text = (FIXTURES / "ur5e.urdf").read_text()
    text = text.replace("1.570796327", "1.5707963267948966")
    paths = []
    for number, version in enumerate((text, text.replace(exact, rounded))):
        path = tmp_path / f"robot{number}.urdf"
        path.write_text(version)
        paths.append(path)
    chains = [select_chain(load_tree(p)) for p in paths]
    first, second = (emitted(to_dh(c), tmp_path) for c in chains)
    rng = np.random.default_rng(3)
    compared = 0
    for q in rng.uniform(-2.0, 2.0, (40, 6)):
        if abs(np.sin(q[4])) < 0.2 or abs(np.sin(q[2])) < 0.2:
            continue
        rows = second.solve(chain_forward(chains[1], q), limits=False).q
        near = first.solve(chain_forward(chains[0], q), limits=False).q
        assert np.abs((rows - q + np.pi) % (2 * np.pi) - np.pi).max(axis=1).min() < 1e-8
        gap = np.abs((rows[:, None] - near[None] + np.pi) % (2 * np.pi) - np.pi).max(axis=2)
        compared += int((gap.min(axis=1) < size * 20).all())
    assert compared > 20


def test_a_file_far_from_exact_keeps_solutions_near_folds(tmp_path: Path) -> None:
    """The elbow nearly stretched: by less than the file's angles are off."""
    text = (FIXTURES / "ur5e.urdf").read_text().replace("1.570796327", "1.57125")
    path = tmp_path / "robot.urdf"
    path.write_text(text)
    chain = select_chain(load_tree(path))
    dh = to_dh(chain)
    assert max(dh.deviation) > 1e-4
    module = emitted(dh, tmp_path)
    rng = np.random.default_rng(5)
    q = rng.uniform(-2.0, 2.0, (150, 6))
    q[:, 2] = rng.uniform(0.003, 0.06, 150) * rng.choice((-1.0, 1.0), 150)
    poses = np.array([chain_forward(chain, row) for row in q])
    batch, count, _ = module.solve_batch(poses, limits=False)
    for i in range(len(q)):
        single = module.solve(poses[i], limits=False).q
        assert (
            np.abs(np.array([chain_forward(chain, row) for row in single]) - poses[i]).max() < 2e-9
        )
        for rows in (single, batch[i, : count[i]]):
            gap = np.abs((rows - q[i] + np.pi) % (2 * np.pi) - np.pi).max(axis=1)
            assert gap.min(initial=np.inf) < 1e-5, q[i]
