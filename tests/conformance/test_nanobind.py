"""The compiled package, built and installed by pip: the Python module's interface and numbers."""

from __future__ import annotations

import importlib
import os
import subprocess
import sys
import venv
from pathlib import Path
from types import ModuleType

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
"""How nanobind itself is compiled: at once, and not for speed. What is emitted says what it needs."""


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
    target = folder / "site"
    venv.create(folder / "venv", with_pip=False)
    pip = [sys.executable, "-m", "pip", "--python", folder / "venv/bin/python", "install"]
    command = [*pip, "--no-deps", "--target", target, folder / name]
    subprocess.run(command, check=True, env={**os.environ, "CMAKE_ARGS": QUICK})
    sys.path.insert(0, str(target))
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
    for options in ({}, {"seed": q}, {"seed": q[0]}, {"limits": False}):
        one, other = (m.solve_batch(poses, **options) for m in both)
        assert alike(one[0], other[0])
        assert (one[1] == other[1]).all() and (one[2] == other[2]).all()


PYTHON_ALONE = {"arm_angle", "Interval", "Path", "follow", "search", "self_motion"}
"""What the compiled package has not."""


@pytest.mark.slow
def test_constants_and_errors_are_the_python_modules(both: tuple[ModuleType, ModuleType]) -> None:
    native, python = both
    for name in set(python.__all__) - PYTHON_ALONE:
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
    ):
        for m in both:
            with pytest.raises(ValueError):
                call(m)
    pose[0, 3] = np.nan
    assert native.solve(pose.tolist()).status is native.Status.INVALID


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
