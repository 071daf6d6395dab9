"""A compiled package without a compiler: its `_native` is the emitted Python module, which takes plain
arrays alone, as the compiled one does."""

from __future__ import annotations

import importlib.util
import itertools
import sys
from pathlib import Path
from types import ModuleType

from tests.support.solving import import_text

from ikgen.emit.nanobind import emit
from ikgen.emit.python.python_emitter import emit_module
from ikgen.emit.solver_module import SolverModule

__all__ = ["NATIVE", "package_and_module"]

NATIVE = '''"""Stands for the compiled module."""

import math
import sys

import numpy as np

python = sys.modules[{module!r}]
STATUSES = list(python.Status)
taken = []


class Found:
    def __init__(self, found):
        self.q, self.singular, self.off = found.q, found.singular, found.off
        self.status = STATUSES.index(found.status)

    def __len__(self):
        return len(self.q)


def row(values, n):
    if type(values) in (list, tuple):
        good = len(values) == n and all(isinstance(x, float) and math.isfinite(x) for x in values)
        return np.array(values) if good else None
    good = isinstance(values, np.ndarray) and values.dtype == float and values.shape == (n,)
    return values if good and np.isfinite(values).all() else None


def solve(pose, held, seed, limits, project):
    good = isinstance(pose, np.ndarray) and pose.dtype == float and pose.shape == (4, 4)
    values = None if held is None or isinstance(held, dict) else row(held, len(python.FREE_JOINTS))
    near = None if seed is None else row(seed, python.DOF)
    if isinstance(held, dict):
        values = row([held.get(name) for name in python.FREE_JOINTS], len(held))
    if not good or (held is not None and values is None) or (seed is not None and near is None):
        return None
    taken.append("solve")
    return Found(python.solve(pose, free=values, seed=near, limits=limits, project=project))


def rows(values, n):
    return None if not len(values) else np.broadcast_to(values, (n, values.shape[1]))


def solve_batch(poses, held, seed, limits):
    near, values = rows(seed, len(poses)), rows(held, len(poses))
    q, count, names = python.solve_batch(poses, free=values, seed=near, limits=limits)
    return q, count, np.array([STATUSES.index(name) for name in names], dtype=np.int64)


def search(pose, seed, prefer, limits):
    near = seed[0] if len(seed) else None
    return Found(python.search(pose, seed=near, prefer=prefer, limits=limits))


def follow(poses, start, limits):
    path = python.follow(poses, start=start, limits=limits)
    return path.q, path.reached, STATUSES.index(path.status), path.singular


def self_motion(pose, limits):
    return [(one.low, one.high, one.branch) for one in python.self_motion(pose, limits=limits)]


def forward(q):
    return None if row(q, python.DOF) is None else python.forward(q)


def jacobian(q):
    return None if row(q, python.DOF) is None else python.jacobian(q)


def rows_forward(q):
    return python.forward(q)


def rows_jacobian(q):
    return np.array([python.jacobian(one) for one in q]).reshape(-1, 6, python.DOF)


def arm_angle(q):
    return python.arm_angle(q)
'''

_count = itertools.count()


def package_and_module(module: SolverModule, folder: Path) -> tuple[ModuleType, ModuleType]:
    """The package of an arm, and the Python module that solves for it."""
    python = import_text(emit_module(module), folder)
    name = f"fake_{next(_count)}_ik_ext"
    (folder / name).mkdir()
    package = f"{module.name}_ik_ext"
    text = emit(module)[f"{package}/{package}/__init__.py"]
    (folder / name / "__init__.py").write_text(text, encoding="utf-8")
    (folder / name / "_native.py").write_text(NATIVE.format(module=python.__name__))
    spec = importlib.util.spec_from_file_location(
        name, folder / name / "__init__.py", submodule_search_locations=[str(folder / name)]
    )
    assert spec is not None and spec.loader is not None
    made = sys.modules[name] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(made)
    return made, python
