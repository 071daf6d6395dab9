"""`ikgen.compile`: an arm whose solver is compiled, with the functions of `Arm`."""

from __future__ import annotations

import hashlib
import importlib.util
import os
import platform
import sys
import sysconfig
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

import numpy as np

from ikgen.errors import MissingToolError, VerificationError
from ikgen.kinematics.joint_box import joint_box
from ikgen.library.load_arguments import wrong
from ikgen.library.loaded_arm import Arm
from ikgen.library.solver_cache import cache_folder
from ikgen.model.arrays import Array
from ikgen.processes.scratch_folder import ScratchFolder

if TYPE_CHECKING:
    from ikgen.runtime.python.rows.solutions import Solutions
    from ikgen.runtime.python.solving.path_following import Path as JointPath

__all__ = ["CompiledArm", "compile"]

_POSES = 64


class CompiledArm(Arm):
    """An `Arm` whose functions run compiled: `compiled` is the module of the nanobind package. What they
    take and give is what those of `Arm` do."""

    def __init__(self, arm: Arm, compiled: ModuleType) -> None:
        super().__init__(arm._request, arm._outputs, arm._entry, arm._derived)
        self.module = arm.module  # what both give is of its classes
        self.compiled = compiled

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickles and copies carry the arm, whose binary the cache has; one that is gone is made again."""
        return compile, (Arm(self._request, self._outputs, self._entry),)

    @property
    def _functions(self) -> ModuleType:
        return self.compiled

    def _solutions(self, found: Any) -> Solutions:
        told = found.singular, found.reason, found.names, found.projected
        rows: Solutions = self.module.Solutions(found.q, self._status(found), *told)
        return rows

    def _path(self, found: Any) -> JointPath:
        path: JointPath = self.module.Path(
            found.q, found.reached, self._status(found), found.singular
        )
        return path

    def _status(self, found: Any) -> Any:
        return self.module.Status[found.status.name]


def compile(arm: Arm) -> CompiledArm:
    """The arm with a compiled solver: the nanobind package, built here and kept in the cache.

    Needs a C++ compiler, Eigen and the package nanobind (`MissingToolError` says what is missing). Raises
    `VerificationError` where it does not compile, or its rows are not those of the Python module.
    """
    from ikgen.emit.nanobind import emit, package_folder

    if not isinstance(arm, Arm):
        raise wrong("arm", arm, "what ikgen.load gives: ikgen.compile(arm)")
    texts = emit(arm.derivation.whole.module)
    package = package_folder(arm.name)
    folder = cache_folder() / "compiled" / _key(texts)
    if not list((folder / package).glob("_native*")):
        folder.parent.mkdir(parents=True, exist_ok=True)
        _build(texts, package, folder)
    compiled = CompiledArm(arm, _loaded(folder / package, package))
    _compare(arm, compiled)
    return compiled


def _key(texts: Mapping[str, str]) -> str:
    """Digest of what a binary is made from, and of what runs it."""
    told = [sys.version, platform.machine(), os.environ.get("CXX", ""), *sorted(texts.items())]
    return hashlib.sha256(repr(told).encode()).hexdigest()


def _build(texts: Mapping[str, str], package: str, folder: Path) -> None:
    """Compile into a folder beside, which then is moved into place."""
    from ikgen.outputs.publish import write_texts
    from ikgen.verify.runners.cpp_toolchain import compile_extension

    nanobind = _nanobind()
    with ScratchFolder("made-", folder.parent) as scratch:
        root = scratch / "made"
        write_texts(root, texts)
        suffix = sysconfig.get_config_var("EXT_SUFFIX")
        made = root / package / package / f"_native{suffix}"
        sources = [root / package / "native.cpp", nanobind / "src/nb_combined.cpp"]
        headers = [nanobind / "include", nanobind / "ext/robin_map/include"]
        # a domain of its own: types of another arm of that name are not this one's
        domain = f"NB_DOMAIN=ikgen_{folder.name[:16]}"
        compile_extension(sources, made, [root / package, *headers], domain)
        try:
            (root / package).rename(folder)
        except OSError:
            if not folder.is_dir():  # another process was faster
                raise


def _nanobind() -> Path:
    found = importlib.util.find_spec("nanobind")
    if found is None or not found.submodule_search_locations:
        raise MissingToolError(
            "the package nanobind is not installed", hint="pip install 'ikgen[compile]'"
        )
    return Path(found.submodule_search_locations[0])


@cache
def _loaded(folder: Path, package: str) -> ModuleType:
    """The package in a folder, which leaves its name to one that is installed."""
    names = (package, f"{package}._native")
    others = {name: sys.modules.pop(name) for name in names if name in sys.modules}
    spec = importlib.util.spec_from_file_location(
        package, folder / "__init__.py", submodule_search_locations=[str(folder)]
    )
    assert spec is not None and spec.loader is not None
    module = sys.modules[package] = importlib.util.module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
    finally:
        for name in names:
            sys.modules.pop(name, None)
        sys.modules.update(others)
    return module


def _compare(arm: Arm, compiled: CompiledArm) -> None:
    """Rows at some poses; both are the same program, of which the Python module was verified. In which
    order they come, and which stand for a continuum, hangs on last digits."""
    from ikgen.verify.agreement import TOLERANCE

    rng = np.random.default_rng(0)
    low, high = joint_box(arm.derivation.dh, np.pi, 2.0 * np.pi)
    poses = arm.forward(rng.uniform(low, high, (_POSES, arm.dof)))
    rows, count, _ = compiled.solve_batch(poses)
    for pose, batch, many in zip(poses, rows, count, strict=True):
        mine, theirs = compiled.solve(pose), arm.solve(pose)
        alike = mine.status is theirs.status
        alike &= all(_apart(q, theirs.q) < TOLERANCE for q in (mine.q, batch[:many]))
        if not (alike or mine.singular.any() or theirs.singular.any()):
            raise VerificationError(
                f"the compiled solver of {arm.name} gives other rows than the Python module",
                hint="please report it with the robot description and the compiler's version",
            )


def _apart(one: Array, other: Array) -> float:
    """How far a row (dof,) of either is from the nearest of the other's at most, in rad, m, or of a longer
    slide; infinite where one has more."""
    if len(one) != len(other):
        return np.inf
    scale = np.maximum(1.0, np.abs(other))
    gaps = (np.abs(one[:, None] - other) / scale).max(axis=2)
    return max(float(gaps.min(axis=k, initial=np.inf).max(initial=0.0)) for k in (0, 1))
