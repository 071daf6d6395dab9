"""The compiled package, built and installed by pip: the Python module's interface and numbers."""

from __future__ import annotations

import importlib
import os
import subprocess
import sys
import venv
from pathlib import Path
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.cpp_modules import ROBOTS, solver_module
from tests.support.held_arms import held_module
from tests.support.solving import import_text

from ikgen.emit.nanobind import emit
from ikgen.emit.python.python_emitter import emit_module
from ikgen.emit.solver_module import SolverModule

Array = NDArray[np.float64]

pytestmark = pytest.mark.usefixtures("solved_once")


QUICK = "-DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=0 '-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG'"
"""How nanobind itself is compiled: at once, and not for speed."""
OPTIMIZED = "-O3"
"""What the emitted project asks for: compiling takes twice as long with it as without."""


def test_the_folder_stands_alone() -> None:
    module = solver_module(ROBOTS[0])
    name = f"{module.name}_ik_ext"
    files = emit(module)
    assert all(path.startswith(f"{name}/") for path in files)
    assert {f"{name}/pyproject.toml", f"{name}/CMakeLists.txt", f"{name}/{name}/py.typed"} <= {
        *files
    }
    assert f'#include "{module.name}_ik.hpp"' in files[f"{name}/native.cpp"]


def installed(module: SolverModule, folder: Path) -> tuple[ModuleType, ModuleType]:
    """The installed package, and the Python module of the same arm."""
    name = f"{module.name}_ik_ext"
    for path, text in emit(module).items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text)
    listing = folder / name / "CMakeLists.txt"
    text = listing.read_text()
    assert text.count(OPTIMIZED) == 1
    listing.write_text(text.replace(OPTIMIZED, "-O1"))
    target = folder / "site"
    venv.create(folder / "venv", with_pip=False)
    pip = [sys.executable, "-m", "pip", "--python", folder / "venv/bin/python", "install"]
    command = [*pip, "--no-deps", "--target", target, folder / name]
    subprocess.run(command, check=True, env={**os.environ, "CMAKE_ARGS": QUICK})
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(target))
        return importlib.import_module(name), import_text(emit_module(module), folder)


@pytest.fixture(scope="module")
def both(tmp_path_factory: pytest.TempPathFactory) -> tuple[ModuleType, ModuleType]:
    folder = tmp_path_factory.mktemp("nanobind")
    return installed(held_module("arm_angle", folder), folder)


def alike(one: Array, other: Array) -> bool:
    """Whether rows are the same: half a turn has two signs where a joint has no limits."""
    same = np.abs(np.sin(0.5 * (one - other))) < 1e-9
    return bool((same | (np.isnan(one) & np.isnan(other))).all())


@pytest.mark.slow
def test_answers_are_the_python_modules(both: tuple[ModuleType, ModuleType]) -> None:
    native, python = both
    q = np.random.default_rng(0).uniform(-2.0, 2.0, (100, 7))
    poses = python.forward(q)
    assert np.allclose(native.forward(q), poses, atol=1e-12)
    assert np.allclose(native.jacobian(q[0]), python.jacobian(q[0]), atol=1e-12)
    for i, pose in enumerate(poses):
        for options in ({}, {"seed": q[i]}, {"limits": False}):
            mine, its = native.solve(pose, **options), python.solve(pose, **options)
            assert mine.status.value == its.status.value and len(mine) == len(its)
            assert alike(mine.q, its.q)
            assert (mine.singular == its.singular).all() and len(list(mine)) == len(mine)
            assert mine.branch == its.branch and mine.reason == its.reason
    for options in ({}, {"seed": q}, {"seed": q[0]}, {"limits": False}):
        one, other = (m.solve_batch(poses, **options) for m in both)
        assert alike(one[0], other[0])
        assert (one[1] == other[1]).all() and (one[2] == other[2]).all()


@pytest.mark.slow
def test_constants_and_errors_are_the_python_modules(both: tuple[ModuleType, ModuleType]) -> None:
    native, python = both
    assert native.__all__ == python.__all__
    for name in python.__all__:
        mine, its = getattr(native, name), getattr(python, name)
        assert callable(its) or np.array_equal(mine, its), name
    pose = python.forward(np.zeros(7))
    for call in (
        lambda m: m.solve(np.eye(3)),
        lambda m: m.solve(pose, seed=[1.0]),
        lambda m: m.solve(pose, seed=[np.nan] * 7),
        lambda m: m.solve_batch([pose, pose], seed=[[0.0] * 7, [np.inf] * 7]),
        lambda m: m.solve(pose, free={"none": 1.0}),
        lambda m: m.solve_batch(pose),
        lambda m: m.forward([1.0, 2.0]),
        lambda m: m.solve(pose + 0.5j),
        lambda m: m.search(pose, prefer="far"),
        lambda m: m.follow([pose], start=[1.0]),
        lambda m: m.self_motion(np.eye(3)),
    ):
        for m in both:
            with pytest.raises(ValueError):
                call(m)
    pose[0, 3] = np.nan
    refused = native.solve(pose.tolist())
    assert refused.status is native.Status.INVALID
    assert refused.reason == python.solve(pose).reason != ""


@pytest.mark.slow
def test_an_arm_angle_is_held_by_its_name(both: tuple[ModuleType, ModuleType]) -> None:
    native, python = both
    assert native.FREE_JOINTS == python.FREE_JOINTS == ("arm_angle",)
    for q in np.random.default_rng(1).uniform(python.LOWER, python.UPPER, (20, 7)):
        pose, angle = python.forward(q), float(python.arm_angle(q))
        for options in ({"free": {"arm_angle": angle}}, {"free": [angle]}, {"seed": q}, {}):
            mine, its = native.solve(pose, **options), python.solve(pose, **options)
            assert mine.status.value == its.status.value and len(mine) == len(its)
            assert alike(mine.q, its.q)
    with pytest.raises(ValueError, match="elbow"):
        native.solve(pose, free={"elbow": 1.0})


@pytest.mark.slow
def test_poses_have_the_forms_that_the_python_module_takes(
    both: tuple[ModuleType, ModuleType],
) -> None:
    native, python = both
    row = np.linspace(-0.5, 0.7, 7)
    pose = python.forward(row)
    for form in (
        pose.tolist(),
        np.asfortranarray(pose),
        pose[:3],
        (pose[:3, :3], pose[:3, 3]),
        SimpleNamespace(homogeneous=pose),
        pose[::-1][::-1],
    ):
        assert alike(native.solve(form, seed=row).q, native.solve(pose, seed=row).q)
    batch = [SimpleNamespace(homogeneous=pose)] * 2
    assert alike(native.solve_batch(batch)[0], native.solve_batch(np.array([pose, pose]))[0])
    rough = pose.round(4)
    assert native.solve(rough).reason == python.solve(rough).reason
    assert len(native.solve(rough, orthonormalize=True)) == len(native.solve(pose)) > 0
    for limits in ("no", None):
        assert alike(native.solve(pose, limits=limits).q, python.solve(pose, limits=limits).q)
    far = pose + 5.0 * np.eye(4, k=3)
    mine, its = native.solve(far, project=True), python.solve(far, project=True)
    assert len(mine) == len(its) > 0 and np.allclose(mine.off[0], its.off[0], atol=1e-6)


@pytest.mark.slow
def test_searches_and_paths_are_the_python_modules(both: tuple[ModuleType, ModuleType]) -> None:
    native, python = both
    rng = np.random.default_rng(2)
    for q in rng.uniform(0.6 * python.LOWER, 0.6 * python.UPPER, (5, 7)):
        pose = python.forward(q)
        assert alike(native.arm_angle(q), python.arm_angle(q))
        mine, its = native.self_motion(pose), python.self_motion(pose)
        assert [one.branch for one in mine] == [one.branch for one in its]
        ends = [np.array([(one.low, one.high) for one in found]) for found in (mine, its)]
        assert np.abs(ends[0] - ends[1]).max() < 1e-6 and isinstance(mine[0], native.Interval)
        best, other = native.search(pose, seed=q), python.search(pose, seed=q)
        assert best.status.value == other.status.value == "OK"
        assert np.abs(best[0] - other[0]).max() < 1e-3 and best.branch[0] == other.branch[0]
        rows = q + np.linspace(0.0, 0.2, 20)[:, None] * rng.normal(size=7)
        one, two = (m.follow(python.forward(rows), start=q) for m in both)
        assert one.reached == two.reached and one.status.value == two.status.value
        assert alike(one.q, two.q) and isinstance(one, native.Path)
        assert (one.singular == two.singular).all()
