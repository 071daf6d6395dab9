"""Maps: the same bytes whoever computes them, and what the solver itself says of each pose."""

from __future__ import annotations

import os
import re
import shutil
import signal
import sys
import zlib
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from ikgen.derivation.derive import derive
from ikgen.emit.derivation import Derivation
from ikgen.kinematics.forward import file_jacobian
from ikgen.processes.executors import Workers, run_pieces
from ikgen.reach.engine import Block, Compiled, solve_block
from ikgen.reach.grid import Grid, grid_over, orientations
from ikgen.reach.png_image import png
from ikgen.reach.reach_map import ReachMap, engine_of, interpreted_engine, reach_map
from ikgen.reach.slices_page import slices_page
from ikgen.reach.stored_map import archive
from ikgen.records.request import Request
from ikgen.report.worked_example import solver_of

pytestmark = pytest.mark.usefixtures("solved_once")

ROOT = Path(__file__).resolve().parents[2]
UR5E = ROOT / "urdf_fixtures/ur5e.urdf"


@cache
def derivation() -> Derivation:
    return derive(Request(UR5E, tip="tool0"))


@cache
def grid() -> Grid:
    return grid_over(derivation().reading.dh, 8, 5, 2)


@cache
def compiled() -> Compiled:
    """The program that solves blocks of it, for any processor."""
    engine, _ = engine_of(derivation(), portable=True, warn=pytest.fail)
    assert isinstance(engine, Compiled)
    return engine


@cache
def by_numpy() -> ReachMap:
    """The map of the NumPy engine, as where there is no compiler."""
    engine = interpreted_engine(derivation())
    return reach_map(derivation(), grid(), engine, engine.size, Workers(count=1))


def test_orientations_are_rotations_spread_over_the_sphere() -> None:
    R = orientations(50, 3)
    np.testing.assert_allclose(
        R @ R.transpose(0, 2, 1), np.tile(np.eye(3), (150, 1, 1)), atol=1e-12
    )
    assert np.allclose(np.linalg.det(R), 1)
    z = R[::3, :, 2]
    assert np.abs(z.mean(axis=0)).max() < 0.05
    apart = np.linalg.norm(z[:, None] - z[None], axis=2) + 9 * np.eye(50)
    assert apart.min() > 0.2 and apart.min(axis=1).max() < 0.8
    assert np.allclose(R[0::3, :, 2], R[1::3, :, 2])


def test_the_grid_holds_what_the_tip_reaches() -> None:
    g = grid()
    solver = solver_of(derivation())
    assert solver is not None
    q = np.random.default_rng(0).uniform(-3, 3, (3000, 6))
    tips = solver.forward(q)[:, :3, 3]
    step = g.x[1] - g.x[0]
    for axis, x in enumerate((g.x, g.y, g.z)):
        assert x[0] - step < tips[:, axis].min() and tips[:, axis].max() < x[-1] + step
        np.testing.assert_allclose(np.diff(x), step)
    assert g.poses == len(g.positions) * 10 == np.prod(g.shape)


def test_every_pose_is_what_solve_says() -> None:
    found, g = by_numpy(), grid()
    solver = solver_of(derivation())
    assert solver is not None
    lower, upper = solver.constants.lower, solver.constants.upper
    assert 0.1 < found.solved < 0.9
    picked = np.random.default_rng(1).choice(g.poses, 60, replace=False)
    scale = np.array([1 / found.size] * 3 + [1.0] * 3)[:, None]
    for place in picked:
        p, r = divmod(int(place), g.shape[3])
        T = np.eye(4)
        T[:3, :3], T[:3, 3] = g.rotations[r], g.positions[p]
        q, _, _ = solver.solve(T)
        at = np.unravel_index(place, g.shape)
        assert found.count[at] == len(q)
        if len(q):
            J = file_jacobian(derivation().reading.dh, q) * scale
            sigma = np.linalg.svd(J, compute_uv=False)[:, -1].max()
            margin = (np.minimum(q - lower, upper - q) / (upper - lower) * 2).min(axis=1).max()
            np.testing.assert_allclose(found.sigma[at], sigma, rtol=1e-4, atol=1e-6)
            np.testing.assert_allclose(found.margin[at], margin, atol=1e-5)


@pytest.mark.skipif(shutil.which("c++") is None, reason="needs a C++ compiler")
def test_compiled_and_interpreted_maps_agree_and_workers_do_not_matter() -> None:
    size = by_numpy().size
    one = reach_map(derivation(), grid(), compiled(), size, Workers(count=1))
    two = reach_map(derivation(), grid(), compiled(), size, Workers(count=2))
    assert archive(one) == archive(two)
    assert (one.count != by_numpy().count).mean() < 2e-3  # poses on the boundary of the reach
    same = one.count == by_numpy().count
    np.testing.assert_allclose(one.sigma[same], by_numpy().sigma[same], rtol=1e-5, atol=1e-6)
    np.testing.assert_allclose(one.margin[same], by_numpy().margin[same], atol=1e-5)


def once_killed(job: tuple[str, int]) -> int:
    """The square of a number; the first process that takes 3 is killed."""
    folder, n = job
    mark = Path(folder, "killed")
    if n == 3 and not mark.exists():
        mark.write_text("")
        os.kill(os.getpid(), signal.SIGKILL)
    return n * n


@pytest.mark.skipif(sys.platform == "win32", reason="needs SIGKILL")
def test_a_lost_worker_costs_no_result(tmp_path: Path) -> None:
    jobs = [(str(tmp_path), n) for n in range(8)]
    assert run_pieces(Workers(count=2), once_killed, jobs) == [n * n for n in range(8)]
    assert (tmp_path / "killed").exists()


def test_dask_gives_the_same_and_survives_a_lost_worker(tmp_path: Path) -> None:
    pytest.importorskip("distributed")
    jobs = [(str(tmp_path), n) for n in range(8)]
    assert run_pieces(Workers("dask", 2), once_killed, jobs) == [n * n for n in range(8)]
    assert (tmp_path / "killed").exists()


@pytest.mark.skipif(sys.platform == "win32", reason="needs SIGKILL")
@pytest.mark.skipif(shutil.which("c++") is None, reason="needs a C++ compiler")
def test_dask_gives_the_same_map_when_a_worker_is_killed_half_way() -> None:
    """One of two, by the address that Dask knows it by; more than half of the blocks are left then."""
    distributed = pytest.importorskip("distributed")
    fine, size = grid_over(derivation().reading.dh, 40, 20, 1), by_numpy().size
    killed: list[tuple[int, int, int]] = []

    def kill_one(ready: int, total: int) -> None:
        if not killed and ready >= total // 3:
            process = min(distributed.Client.current().run(os.getpid).values())
            os.kill(process, signal.SIGKILL)
            killed.append((process, ready, total))

    by_dask = reach_map(derivation(), fine, compiled(), size, Workers("dask", 2), kill_one)
    ((_, ready, total),) = killed
    assert 1 <= ready <= total / 2
    assert archive(by_dask) == archive(reach_map(derivation(), fine, compiled(), size, None))


def test_blocks_of_any_size_are_read_right() -> None:
    """A number of poses that is no multiple of four."""
    engine = interpreted_engine(derivation())
    g = grid()
    one = solve_block(Block(engine, g.positions[:3], g.rotations[:1]))
    assert [len(one.count), len(one.sigma), len(one.margin)] == [3, 3, 3]


def test_images_are_pngs() -> None:
    image = png(np.array([[0.0, 0.5], [1.0, 0.25]]), 3)
    assert image.startswith(b"\x89PNG")
    start = image.index(b"IDAT") + 4
    raw = zlib.decompress(
        image[start : start + int.from_bytes(image[start - 8 : start - 4], "big")]
    )
    assert len(raw) == 6 * (1 + 6 * 4)
    assert raw[4] == 0 and raw[1 + 3 * 4 + 3] == 255  # nothing is transparent, something is not


def test_the_page_is_one_file() -> None:
    page = slices_page(by_numpy(), "ikgen reach <robot>")
    assert "<script" not in page and "http" not in page and "&lt;robot&gt;" in page
    assert page.count("<img") > 12 and len(page) < 1.5e6
    share = f"{100 * by_numpy().solved:.1f} % with a solution"
    assert share in page


def marks(page: str) -> list[list[str]]:
    """The numbers beside each bar of colours."""
    return [re.findall(">([^<]+)</span>", bar) for bar in page.split('<div class="marks">')[1:]]


def test_bars_of_colours_have_numbers() -> None:
    shares, solutions, best, room = marks(slices_page(by_numpy(), ""))
    assert shares == ["0 %", "25 %", "50 %", "75 %", "100 %"]
    assert solutions == ["0", "2", "4", "6", "8"] and by_numpy().count.max() == 8
    assert room == ["0", "0.25", "0.5", "0.75", "1"]
    assert len(best) == 5 and best[0] == "0" and best[4] == f"{by_numpy().sigma.max():.3g}"
    for most, expected in ((6, ["0", "2", "4", "6"]), (1, ["0", "1"]), (0, ["0"])):
        fewer = replace(by_numpy(), count=np.minimum(by_numpy().count, most))
        assert marks(slices_page(fewer, ""))[1] == expected
