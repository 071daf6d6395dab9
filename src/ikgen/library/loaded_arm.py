"""An arm in memory: its solver, where it came from, and how it was checked."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ikgen.errors import ArgumentError, UsageError
from ikgen.library.argument_words import argument_words, in_argument_words
from ikgen.library.load_arguments import checked_flag, checked_path, wrong
from ikgen.library.memory_module import module_of
from ikgen.model.counted import counted

if TYPE_CHECKING:
    from ikgen.emit.derivation import Derivation
    from ikgen.library.arm_derivation import ArmDerivation
    from ikgen.library.solver_cache import SolverEntry
    from ikgen.records.request import Outputs, Request
    from ikgen.runtime.python.held.self_motion import Interval
    from ikgen.runtime.python.rows.solutions import Solutions
    from ikgen.runtime.python.solving.path_following import Path as JointPath
    from ikgen.verify.verification_report import VerificationReport

__all__ = ["Arm"]

Array = NDArray[np.float64]

_FLAGS = {"limits", "project", "orthonormalize"}
"""Arguments that are true or false."""


class Arm:
    """A robot's arm with its inverse kinematics, as `ikgen.load` gives it.

    Its functions are those of the emitted module (`docs/reference/python-api.md`), which is `module`;
    `source` is the module's text. Values are in rad and m, poses those of the tip in the base.
    Functions raise `ArgumentError` for arguments that do not do.
    """

    def __init__(
        self,
        request: Request,
        outputs: Outputs,
        entry: SolverEntry,
        derivation: Derivation | None = None,
    ) -> None:
        """`derivation` is that of the solver where it was just made; else it is made when asked for."""
        self._request, self._outputs, self._entry = request, outputs, entry
        self._derived = derivation

    def __getstate__(self) -> dict[str, Any]:
        """What pickles and copies carry: the module is made from its text, a derivation when asked for."""
        names = ("_request", "_outputs", "_entry")
        return {"_derived": None, **{name: self.__dict__[name] for name in names}}

    @property
    def name(self) -> str:
        """The arm's name, which begins the names of its files."""
        return self._entry.name

    @property
    def source(self) -> str:
        """The text of the Python module."""
        return self._entry.text

    @cached_property
    def module(self) -> ModuleType:
        """The Python module, as `import` would give it from a file."""
        return module_of(self.name, self.source)

    @property
    def joint_names(self) -> tuple[str, ...]:
        """The joints, base to tip; held ones included, locked ones not."""
        names: tuple[str, ...] = self.module.JOINT_NAMES
        return names

    @property
    def dof(self) -> int:
        """How many joints there are."""
        return len(self.joint_names)

    @property
    def lower(self) -> Array:
        """Lower limits (dof,) in rad or m; -inf where the file sets none."""
        return np.array(self.module.LOWER)

    @property
    def upper(self) -> Array:
        """Upper limits (dof,) in rad or m; inf where the file sets none."""
        return np.array(self.module.UPPER)

    @property
    def free_joints(self) -> tuple[str, ...]:
        """Joints that are held: their values are an input of `solve`."""
        names: tuple[str, ...] = self.module.FREE_JOINTS
        return names

    @property
    def base_link(self) -> str:
        """The link that poses are given in."""
        return str(self.module.BASE_LINK)

    @property
    def tip_link(self) -> str:
        """The link that is placed."""
        return str(self.module.TIP_LINK)

    @property
    def task(self) -> str:
        """What of a pose counts."""
        return str(self.module.TASK)

    @property
    def max_solutions(self) -> int:
        """Rows of a solution at most."""
        return int(self.module.MAX_SOLUTIONS)

    @property
    def warnings(self) -> tuple[str, ...]:
        """What was odd in the robot's file, and what has to be known of the solver: that its task asks more
        than the arm can do, say, or that a joint hardly moves."""
        return tuple(map(argument_words, self._entry.warnings))

    def forward(self, q: ArrayLike) -> Array:
        """Poses (..., 4, 4) of the tip in the base at q (..., dof)."""
        T: Array = self._call("forward", q)
        return T

    def jacobian(self, q: ArrayLike) -> Array:
        """Geometric Jacobians (..., 6, dof) of the tip in the base: linear rows, then angular."""
        J: Array = self._call("jacobian", q)
        return J

    def solve(
        self,
        pose: Any,
        *,
        free: Sequence[float] | Mapping[str, float] | None = None,
        seed: ArrayLike | None = None,
        limits: bool = True,
        project: bool = False,
        orthonormalize: bool = False,
    ) -> Solutions:
        """All joint values that bring the tip to `pose`: a matrix (4, 4) or (3, 4), a pair (rotation,
        position) or (position, quaternion x y z w), a transform of Pinocchio, SciPy or spatialmath.

        free: values of the held joints; seed: (dof,) values that order the rows by distance, choose
        whole turns, and are taken where the pose leaves a joint free; limits: drop rows outside the
        limits; project: of a pose without rows, those of the nearest pose that the arm can take (`off` says
        by how much); orthonormalize: take the nearest rotation of one that was printed with a few
        digits (off by up to 1e-3). A pose that cannot be reached, or is none, is a status of what comes
        back, and its `reason` says what is wrong with it.
        """
        options = {"free": free, "seed": seed, "limits": limits, "project": project}
        found = self._call("solve", pose, **options, orthonormalize=orthonormalize)
        return self._solutions(found)

    def solve_batch(
        self,
        poses: Any,
        *,
        free: ArrayLike | Mapping[str, float] | None = None,
        seed: ArrayLike | None = None,
        limits: bool = True,
        orthonormalize: bool = False,
    ) -> tuple[Array, NDArray[np.int64], NDArray[np.str_]]:
        """`solve` for N poses: q (N, max_solutions, dof) padded with NaN, counts (N,), status (N,)."""
        found: tuple[Array, NDArray[np.int64], NDArray[np.str_]] = self._call(
            "solve_batch", poses, free=free, seed=seed, limits=limits, orthonormalize=orthonormalize
        )
        return found

    def arm_angle(self, q: ArrayLike) -> Array:
        """The arm angle (rad) of joint values (..., dof): (...). Of arms that hold it."""
        angles: Array = self._call("arm_angle", q)
        return angles

    def self_motion(self, pose: Any, *, limits: bool = True) -> tuple[Interval, ...]:
        """Intervals `low` to `high` of the held joint's value (rad or m) on which the pose has a row of the
        `branch`, inside the limits if these count; ends to 1e-9. Of arms with one held joint."""
        found: tuple[Interval, ...] = self._call("self_motion", pose, limits=limits)
        return found

    def search(
        self,
        pose: Any,
        *,
        seed: ArrayLike | None = None,
        prefer: str = "near",
        limits: bool = True,
    ) -> Solutions:
        """Rows over all values of the held joints, best first, of each branch the best: by `prefer` the
        "near" ones to the seed (dof,), those in the "centre" of the limits, or the most "dexterous", of
        which the smallest singular value of the task's Jacobian (m/s, rad/s) is largest."""
        if not isinstance(prefer, str):
            raise wrong("prefer", prefer, '"near", "centre" or "dexterous"')
        return self._solutions(self._call("search", pose, seed=seed, prefer=prefer, limits=limits))

    def follow(self, poses: Any, *, start: ArrayLike, limits: bool = True) -> JointPath:
        """Joint values along poses (N, 4, 4) on one branch, of the first those next to `start` (dof,), rad
        or m: `q` (N, dof), NaN from the first pose on that was not reached; `reached`, how many were;
        `status`, OK or why the next was not; `singular` (N,)."""
        return self._path(self._call("follow", poses, start=start, limits=limits))

    @property
    def _functions(self) -> ModuleType:
        """What has the functions."""
        return self.module

    def _solutions(self, found: Any) -> Solutions:
        """What was found, of the module's class."""
        rows: Solutions = found
        return rows

    def _path(self, found: Any) -> JointPath:
        """What was found, of the module's class."""
        path: JointPath = found
        return path

    def _call(self, function: str, *arguments: Any, **options: Any) -> Any:
        """What a function of the solver gives; what it refuses, ikgen's own error refuses."""
        called: Callable[..., Any] | None = getattr(self._functions, function, None)
        if called is None:
            raise UsageError(
                f"the solver of {self.name} has no {function}", hint=self._without(function)
            )
        for flag in _FLAGS & options.keys():
            checked_flag(flag, options[flag])
        try:
            return called(*arguments, **options)
        except (ValueError, TypeError) as error:
            text = str(error)
            raise ArgumentError(f"{function}: {text}", hint=self._expected(text)) from error

    def _without(self, function: str) -> str:
        if function == "arm_angle":
            return 'arm_angle is of arms that hold it: load with free="arm-angle"'
        if not self.free_joints:
            return f"{function} is of arms with held joints: this one has none (see free=)"
        return f"modules of this version of ikgen have no {function}"

    def _expected(self, text: str) -> str:
        """What the arguments of the module's functions are."""
        dof, held = self.dof, ", ".join(self.free_joints) or "none"
        words = {
            "free": f"the held joints are: {held}",
            "no free joint": f"the held joints are: {held}",
            "prefer": 'give "near", "centre" or "dexterous"',
            "seed": f"seed has {dof} finite values: {', '.join(self.joint_names)}",
            "start": f"start has {dof} finite values: {', '.join(self.joint_names)}",
            "q ": f"q has {dof} values: {', '.join(self.joint_names)}",
            "pose": "a pose is a 4x4 matrix, or one of docs/reference/library.md#poses",
        }
        return next((hint for start, hint in words.items() if text.startswith(start)), "see help()")

    @cached_property
    def derivation(self) -> ArmDerivation:
        """How the inverse kinematics was derived; made again where the solver came from the cache."""
        from ikgen.library.arm_derivation import ArmDerivation, derived_again

        return ArmDerivation(self._derived or derived_again(self._request, self._entry))

    @property
    def verification(self) -> VerificationReport | None:
        """What the verification found: checks by name and as a table; None where it was left out."""
        return self._entry.report

    @in_argument_words()
    def save(self, folder: Any, emit: str | Iterable[str] = ("python",)) -> tuple[Path, ...]:
        """Write outputs into a folder, each verified: the files. `emit` names outputs, as --emit does."""
        from ikgen.library.arm_files import save

        return save(self._request, self._outputs, checked_path("folder", folder), emit)

    @in_argument_words()
    def report(self, file: Any) -> Path:
        """Write the derivation as a page (.html), LaTeX (.tex, .pdf) or the solution graph (.svg)."""
        from ikgen.library.arm_files import write_page

        page = checked_path("file", file)
        return write_page(lambda: self.derivation.whole, self.verification, page)

    def __repr__(self) -> str:
        held = f", holding {', '.join(self.free_joints)}" if self.free_joints else ""
        return (
            f"<ikgen.Arm {self.name}: {self.base_link} -> {self.tip_link}, "
            f"{counted(self.dof, 'joint')}{held}, task {self.task}, "
            f"at most {counted(self.max_solutions, 'solution')}>"
        )

    def _repr_html_(self) -> str:
        """What a notebook shows."""
        return self._entry.card
