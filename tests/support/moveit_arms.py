"""Arms whose MoveIt package is compiled and called in tests."""

from __future__ import annotations

import dataclasses
import functools
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.moveit_driver import Plugin, compile_driver
from tests.support.solving import FIXTURES

from ikgen.derivation.derive import derive
from ikgen.emit.moveit import emit, package_name
from ikgen.emit.solver_module import SolverModule
from ikgen.errors import MissingToolError
from ikgen.importers import load_tree
from ikgen.kinematics.forward import file_forward
from ikgen.model.joint_tree import Joint, JointTree, JointType, Limits
from ikgen.records.request import Request
from ikgen.verify.runners.cpp_toolchain import find_eigen

__all__ = [
    "FRANKA", "KUKA", "MANIPULATOR", "Arm", "compiled_arm", "fixed", "made_arm", "missing_tools",
    "module_of", "needs", "offset", "running", "with_joint", "write_package",
]  # fmt: skip

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Case:
    """How an arm of the fixtures is generated, the headers that its plugin is compiled with, and whether
    each of its sources is compiled by itself."""

    style: str
    options: dict[str, Any] = field(default_factory=dict)
    apart: bool = False


KUKA = "kuka_kr6r900sixx"
FRANKA = "franka_fr3"
MANIPULATOR = "open_manipulator_x"
CASES = {
    KUKA: Case("hpp"),
    FRANKA: Case("h", {"free": {"fr3_joint7": None}}, apart=True),
    MANIPULATOR: Case("hpp", {"task": "position", "free": {"joint2": None}}),
}


def needs(*names: str) -> pytest.MarkDecorator:
    """The test runs for each of these arms."""
    return pytest.mark.parametrize("arm", names, indirect=True)


def missing_tools(*programs: str) -> str:
    """Why something cannot be compiled; empty where it can."""
    absent = [name for name in programs if shutil.which(name) is None]
    try:
        find_eigen()
    except MissingToolError as error:
        return error.message
    return f"needs {', '.join(absent)}" if absent else ""


@functools.cache
def module_of(name: str) -> SolverModule:
    """The solver of an arm."""
    return derive(Request(FIXTURES / f"{name}.urdf", **CASES[name].options)).module


def write_package(module: SolverModule, folder: Path) -> Path:
    """The emitted package's folder."""
    for path, text in emit(module).items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text)
    return folder / package_name(module.name)


@dataclass(frozen=True)
class Arm:
    """A solver, its robot, and the driver around its plugin."""

    module: SolverModule
    tree: JointTree
    program: Path

    @property
    def joints(self) -> list[str]:
        return [joint.name for joint in self.module.dh.joints]

    @property
    def base(self) -> str:
        return self.module.dh.base_link

    @property
    def tip(self) -> str:
        return self.module.dh.tip_link

    @property
    def bounds(self) -> tuple[Array, Array]:
        limits = [joint.limits for joint in self.module.dh.joints]
        return np.array([x.lower for x in limits]), np.array([x.upper for x in limits])

    def configurations(self, seed: int, count: int = 40) -> Array:
        low, high = self.bounds
        return np.random.default_rng(seed).uniform(low, high, (count, len(low)))

    def held(self, q: Array, seed: Array) -> Array:
        """The configuration with the seed's values of the held joints."""
        out = q.copy()
        out[list(self.module.free_indices)] = seed[list(self.module.free_indices)]
        return out

    def pose(self, q: Array) -> Array:
        return file_forward(self.module.dh, q)


def made_arm(robot: Path, **options: Any) -> Arm:
    """The arm of a URDF, its driver compiled beside the file."""
    module = derive(Request(robot, **options)).module
    program = robot.with_suffix("")
    compile_driver(write_package(module, robot.parent), "hpp", program)
    return Arm(module, load_tree(robot), program)


@contextmanager
def running(arm: Arm, tree: JointTree | None = None) -> Iterator[Plugin]:
    """The plugin over the arm's own tree, or another; not yet initialized."""
    plugin = Plugin(arm.program, len(arm.joints))
    plugin.load(tree or arm.tree)
    plugin.group("arm", arm.joints)
    yield plugin
    plugin.close()


@functools.cache
def compiled_arm(name: str, folder: Path) -> Arm:
    """An arm with its driver, compiled by the first process that asks for it."""
    import fcntl

    program = folder / name / "driver"
    program.parent.mkdir(parents=True, exist_ok=True)
    with (folder / f"{name}.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not program.exists():
            package = write_package(module_of(name), program.parent)
            case = CASES[name]
            compile_driver(package, case.style, program, apart=case.apart)
    return Arm(module_of(name), load_tree(FIXTURES / f"{name}.urdf"), program)


def fixed(name: str, parent: str, T: Array) -> Joint:
    """A fixed joint to a new link."""
    free = Limits(-np.inf, np.inf)
    return Joint(f"{name}_joint", JointType.FIXED, parent, name, T, np.array([1.0, 0, 0]), free)


def offset(x: float, turn: float) -> Array:
    T = np.eye(4)
    T[:2, :2] = [[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]
    T[:3, 3] = [x, 0.2, -0.1]
    return T


def with_joint(tree: JointTree, which: str, **changes: object) -> JointTree:
    """The tree with one joint changed."""
    joints = tuple(
        dataclasses.replace(joint, **changes) if joint.name == which else joint  # type: ignore[arg-type]
        for joint in tree.joints
    )
    return dataclasses.replace(tree, joints=joints)
