"""The Python part of compiled packages: the Python module's names, arguments, results and errors."""

from __future__ import annotations

import copy
import dataclasses
import inspect
import pickle
import warnings
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
import pytest
from tests.support.fake_native import package_and_module
from tests.support.geared_arms import SCARA
from tests.support.held_arms import held_module

from ikgen.derivation.derive import derive
from ikgen.emit.nanobind import emit
from ikgen.emit.solver_module import SolverModule
from ikgen.kinematics.motor_matrix import motor_matrix
from ikgen.model.joint_relation import Relation
from ikgen.records.request import Request

pytestmark = pytest.mark.usefixtures("solved_once")

ROOT = Path(__file__).resolve().parents[3]
Both = tuple[ModuleType, ModuleType]


def geared(folder: Path) -> SolverModule:
    path = folder / "scara.urdf"
    path.write_text(SCARA)
    module = derive(Request(path)).module
    first, second = (joint.name for joint in module.dh.joints[:2])
    moved = {second: Relation(((second, 1.0), (first, -0.5)), 0.2)}
    return replace(module, dh=replace(module.dh, transmission=motor_matrix(module.dh, moved)))


ARMS: dict[str, Callable[[Path], SolverModule]] = {
    "sides": lambda folder: held_module("ur5e", folder),
    "held": lambda folder: held_module("franka_fr3", folder),
    "angle": lambda folder: held_module("arm_angle", folder),
    "task": lambda folder: derive(Request(ROOT / "urdf_fixtures/open_manipulator_x.urdf")).module,
    "eliminated": lambda folder: (
        derive(Request(ROOT / "tests/robots/tables/KawasakiRS05L.toml")).module
    ),
    "geared": geared,
}


@pytest.fixture(scope="module", params=ARMS)
def both(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Both:
    folder = tmp_path_factory.mktemp(request.param)
    return package_and_module(ARMS[request.param](folder), folder)


def a_row(m: ModuleType) -> np.ndarray[Any, Any]:
    return np.clip(np.linspace(-0.4, 0.6, m.DOF), m.LOWER, m.UPPER)


def outcome(m: ModuleType, call: Callable[[ModuleType], Any]) -> object:
    """What a call gives, or raises, as something that can be compared."""
    try:
        found = call(m)
    except (TypeError, ValueError) as error:
        return type(error), str(error).replace(m.__name__, "")
    return plain(found)


def plain(value: Any) -> object:
    if isinstance(value, np.ndarray) and value.dtype.kind == "f":
        return value.shape, np.nan_to_num(value, nan=99.0).round(7).tolist()
    if isinstance(value, np.ndarray):
        return str(value.dtype), value.tolist()
    if dataclasses.is_dataclass(value):
        names = [field.name for field in dataclasses.fields(value) if field.name != "names"]
        branch = getattr(value, "branch", None)
        return [plain(getattr(value, name)) for name in names], branch
    return tuple(map(plain, value)) if isinstance(value, tuple) else str(value)


def same(both: Both, call: Callable[[ModuleType], Any]) -> None:
    native, python = both
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert outcome(native, call) == outcome(python, call)


def test_names_and_signatures(both: Both) -> None:
    native, python = both
    assert native.__all__ == python.__all__
    for name in python.__all__:
        mine, theirs = getattr(native, name), getattr(python, name)
        if callable(theirs):
            assert inspect.signature(mine) == inspect.signature(theirs), name
            assert mine.__doc__ == theirs.__doc__
        else:
            assert np.array_equal(mine, theirs), name


def test_poses_of_every_form(both: Both) -> None:
    pose = both[1].forward(a_row(both[1]))
    forms: list[Any] = [
        pose, pose.tolist(), pose[:3], (pose[:3, :3], pose[:3, 3]), ([0.4, 0.2, 0.5], [0.0, 1.0, 0.0, 0.0]),
        SimpleNamespace(homogeneous=pose), SimpleNamespace(as_matrix=lambda: pose),
        [SimpleNamespace(A=pose)],
        np.asfortranarray(pose), pose.astype(np.float32), pose.astype(">f8"), pose.astype(object),
        np.full((4, 4), np.nan), np.diag([1.0, 1.0, -1.0, 1.0]), pose.round(4), pose + 0.5j,
        pose[:3, :3], pose[:3, 3], np.zeros((2, 4, 4)), "here", None, 5.0, {}, [],
    ]  # fmt: skip
    for form in forms:
        same(both, lambda m, form=form: m.solve(form))
        same(both, lambda m, form=form: m.solve(form, orthonormalize=True))
        same(both, lambda m, form=form: m.solve_batch([form, form]))
        same(both, lambda m, form=form: m.solve_batch(form, orthonormalize=True))


def test_poses_of_searches_and_paths(both: Both) -> None:
    row = a_row(both[1])
    pose = both[1].forward(row)
    for form in (pose.tolist(), pose[:3], pose + 0.5j, np.diag([1.0, 1.0, -1.0, 1.0]), "here"):
        same(both, lambda m, form=form: m.follow([form, form], start=row))
        if not both[1].FREE_JOINTS:
            same(both, lambda m, form=form: m.search(form, seed=row))
            same(both, lambda m, form=form: m.search(form, prefer="dexterous"))
        elif hasattr(both[1], "self_motion"):
            same(both, lambda m, form=form: m.self_motion(form, limits=None))


def test_seeds_and_other_joint_values(both: Both) -> None:
    row, n = a_row(both[1]), both[1].DOF
    pose = both[1].forward(row)
    seeds: list[Any] = [
        row, row.tolist(), [0] * n, row.astype(np.float32), np.repeat(row, 2)[::2], row[None], row[:-1],
        [row, row], row + 1j, np.full(n, np.nan), np.full(n, 1e9), ["a"] * n, "near", 3.0, {},
    ]  # fmt: skip
    for seed in seeds:
        same(both, lambda m, seed=seed: m.solve(pose, seed=seed))
        same(both, lambda m, seed=seed: m.solve_batch([pose, pose], seed=seed))
        same(both, lambda m, seed=seed: m.forward(seed))
        if not both[1].FREE_JOINTS:
            same(both, lambda m, seed=seed: m.search(pose, seed=seed))
            same(both, lambda m, seed=seed: m.follow([pose], start=seed))


def test_values_of_what_is_held(both: Both) -> None:
    row = a_row(both[1])
    pose, names = both[1].forward(row), both[1].FREE_JOINTS
    values: list[Any] = [
        [0.1] * len(names), (0.1,) * len(names), [1] * len(names), dict.fromkeys(names, 0.1), {"none": 1.0},
        dict.fromkeys(names, np.nan), dict.fromkeys(names, "a"), {}, 0.1, [0.1, 0.2], [np.nan], [0.1j],
        [[0.1], [0.2]], "held",
    ]  # fmt: skip
    for free in values:
        for seed in (None, row):
            same(both, lambda m, free=free, seed=seed: m.solve(pose, free=free, seed=seed))
            same(both, lambda m, f=free, s=seed: m.solve_batch([pose, pose], free=f, seed=s))


def test_options_count_as_true_or_false(both: Both) -> None:
    pose = both[1].forward(a_row(both[1]))
    for option in ("no", None, 0, 1, "", np.True_):
        same(both, lambda m, option=option: m.solve(pose, limits=option))
        same(both, lambda m, option=option: m.solve_batch([pose], limits=option))
        same(both, lambda m, option=option: m.solve(pose.round(4), orthonormalize=option))
        same(both, lambda m, option=option: m.solve(pose + 3.0, project=option))


def test_what_pose_has_no_row_is_told(both: Both) -> None:
    native, python = both
    pose = python.forward(a_row(python))
    pose[:3, 3] += 1e5
    free = [0.25] * len(python.FREE_JOINTS)
    found = native.solve(pose, free=free)
    free[:] = [9.0] * len(free)  # the reason is made when it is asked for
    assert found.status is native.Status.UNREACHABLE and found.branch == () and len(found) == 0
    assert found.reason == python.solve(pose, free=[0.25] * len(free)).reason
    assert found.q.shape == (0, python.DOF) and found.singular.dtype == bool
    if not python.FREE_JOINTS:
        same(both, lambda m: m.search(pose))


def test_solutions_are_the_python_modules(both: Both) -> None:
    native, python = both
    row = a_row(python)
    pose = python.forward(row)
    found, theirs = native.solve(pose, seed=row), python.solve(pose, seed=row)
    assert isinstance(found, native.Solutions) and repr(found) == repr(theirs)
    assert found.q is found.q and list(map(tuple, found)) == list(map(tuple, theirs.q))
    assert found.branch == theirs.branch and len(found.branch) == len(found) > 0
    assert (found.off == 0.0).all() and found.off.shape == (len(found), 2)
    for again in (pickle.loads(pickle.dumps(found)), copy.deepcopy(found), replace(found)):
        assert isinstance(again, native.Solutions) and plain(again) == plain(found)
    with pytest.raises(dataclasses.FrozenInstanceError):
        found.q = None
    assert not hasattr(found, "homogeneous")
    far = native.solve(np.full((4, 4), np.nan))
    assert pickle.loads(pickle.dumps(far)).reason == far.reason != ""


def test_plain_arrays_go_straight_to_the_solver(both: Both) -> None:
    native, python = both
    row = a_row(python)
    pose, free = python.forward(row), [0.1] * len(python.FREE_JOINTS)
    for options in ({}, {"seed": row}, {"seed": row.tolist()}, {"free": free}):
        native._native.taken.clear()
        native.solve(pose, **options)
        assert native._native.taken == ["solve"]


def test_search_refuses_unknown_preferences(both: Both) -> None:
    pose = both[1].forward(a_row(both[1]))
    for prefer in ("far", None, 3):
        same(both, lambda m, prefer=prefer: m.search(pose, prefer=prefer))


def test_constants_that_are_left_to_be_filled_in_are_the_headers() -> None:
    module = derive(Request(ROOT / "urdf_fixtures/puma560_symbolic.toml")).module
    name = f"{module.name}_ik_ext"
    files = emit(module)
    assert module.dh.symbols
    for blank in module.dh.symbols:
        assert f"{blank}: float = _native.{blank}\n" in files[f"{name}/{name}/__init__.py"]
        assert f'module.attr("{blank}") = ik::{blank};' in files[f"{name}/native.cpp"]
