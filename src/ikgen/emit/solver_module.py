"""What an emitter gets: the Program and the facts of the arm around it."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ikgen.elimination.plan import EliminationPlan
from ikgen.kinematics.displacement import displacements
from ikgen.kinematics.forward import dh_frames
from ikgen.kinematics.position_unit import distance_away, position_unit
from ikgen.kinematics.whole_turns import period_of
from ikgen.model.dh import DHChain
from ikgen.program.policy import SolvePolicy
from ikgen.program.statements import Program
from ikgen.tasks import AXES, Task, find_task
from ikgen.tasks.fitting import freedoms_moved, keeps_heading_level

__all__ = ["CLOSE", "SolverModule", "is_rounded", "most_rows"]

CLOSE = 8e-10
"""Deviation up to which a row that is exact for the solved geometry is right for the file (1e-9)."""

_POSE_ROUND_OFF = 4e-15
"""Error (m) of a pose's position for each metre that it is away, behind a chain of products."""

FAR = 1.5e-5
"""Deviation (rad or m) above which a closed-form row may be too far from the file's solution for Newton
steps near folds, at regular configurations too."""


def is_rounded(dh: DHChain, plan: EliminationPlan | None) -> bool:
    """Whether the file is off what the rules solved, as it rounds the exact geometry."""
    return plan is None and max(dh.deviation) > CLOSE


def most_rows(lanes: int, rounded: bool) -> int:
    """Rows of a solution at most, `lanes` of the closed form. Of a rounded file each row of what was solved
    may lead to two near folds; six joints have sixteen at most."""
    return min(2 * lanes, max(lanes, 16)) if rounded else lanes


@dataclass(frozen=True, slots=True)
class SolverModule:
    """One solver to emit.

    `name` is the prefix of the emitted files (`<name>_ik.py`), `free_defaults` the default values of
    what is `held` inside the limits (rad or m). `source_name` and `source_sha256` tell what it was made
    from, `geometry` is the geometry class in words, `plan` what an elimination needs where the rules did
    not solve the arm. Of a table
    without numbers the constants are left to be filled in, or with `sample` those that its derivation
    was checked with. `followers` are joints that follow others (`JOINT=SOURCE*k+c`, rad or m). `maintainer`
    (`NAME <EMAIL>`) and `license` are for manifests of packages.
    """

    name: str
    program: Program
    dh: DHChain
    task: str
    free_defaults: tuple[float, ...]
    source_name: str
    source_sha256: str
    generator_version: str
    geometry: str = ""
    order: tuple[str, ...] = ()
    plan: EliminationPlan | None = None
    sample: bool = False
    maintainer: str | None = None
    license: str | None = None
    followers: tuple[str, ...] = ()

    @property
    def on_joints(self) -> SolverModule:
        """The module with values of joints, also where motors move several: what robot models have."""
        return replace(self, dh=replace(self.dh, transmission=None))

    @property
    def beyond(self) -> dict[str, str]:
        """What a solver of this arm needs beside the Program and Newton steps on its chain, by name, in
        words: values of `motors` that move several joints (`dh.transmission`), `blanks` in place of numbers
        (`dh.symbols`), and rows with the `arm-angle` that is asked for (`dh.arm_angle`)."""
        dh = self.dh
        needed = {
            "motors": ("motors that move several joints", dh.transmission is not None),
            "blanks": ("constants to be filled in", bool(dh.symbols)),
            "arm-angle": ("the arm angle", dh.arm_angle),
        }
        return {name: words for name, (words, needs) in needed.items() if needs}

    @property
    def free_indices(self) -> tuple[int, ...]:
        """Indices of the joints that are held."""
        return self.dh.free_indices

    @property
    def held(self) -> tuple[str, ...]:
        """Names of what is held: joints, base to tip, then the arm angle."""
        return self.dh.held

    @property
    def rounded(self) -> bool:
        """Whether the closed form is of the exact geometry that the file rounds: then all rows take Newton
        steps on the file's own chain."""
        return is_rounded(self.dh, self.plan)

    @property
    def tells_rough(self) -> bool:
        """Whether the closed form tells the rows that take Newton steps: those of a continuum or on the
        boundary, where it lost digits. Otherwise all do."""
        return not self.rounded and self.plan is None

    @property
    def solved_frames(self) -> tuple[NDArray[np.float64], ...]:
        """The constants (4, 4) of the chain that was solved, as the file's are in `program.frames`; empty
        where the closed form is the file's."""
        return dh_frames(self.dh) if self.rounded else ()

    @property
    def policy(self) -> SolvePolicy:
        """The tolerances of `solve`, six of them of this arm.

        - `exact`: no less than the round-off of entries of the pose, whose digits a base that is far away
          takes.
        - `limit_tolerance`: over `most_driven` and what of the arm's size is more than 1 m, as a joint put
          on its limit moves the tool that many times as far.
        - `fold_reach`: below it a second solution of the file may lie beside a row; grows with the root of
          the deviation.
        - `beside_reach`: below it (everywhere if `far`) displaced poses are solved too, as a solution of
          the file may have no closed-form row to start from.
        - `broken_reach`: below it solutions may lie along a continuum that rounding broke; proportional to
          the deviation.
        - `fold_product`: product of the two smallest singular values below which another solution may come
          in; likewise.
        """
        plain, off = SolvePolicy(), max(self.dh.deviation)
        root, farther = math.sqrt(off), self.dh.most_driven * max(1.0, self.size)
        return replace(
            plain,
            exact=max(plain.exact, _POSE_ROUND_OFF * distance_away(self.dh) / self.size),
            limit_tolerance=plain.limit_tolerance / farther,
            fold_reach=max(plain.fold_reach, plain.fold * root),
            beside_reach=plain.anywhere if self.far else plain.fold * root,
            broken_reach=plain.broken_reach * off,
            fold_product=plain.fold_product * off,
        )

    @property
    def beside(self) -> tuple[NDArray[np.float64], ...]:
        """Small motions (4, 4) of the tool: the poses that they lead to are solved as well as the asked
        one, and all rows take Newton steps to the asked one. Near a fold two solutions of the file's
        geometry may start from one of the solved geometry or from none, but not at all these poses.
        Empty where the closed form is the file's."""
        return displacements(4.0 * max(self.dh.deviation)) if self.rounded else ()

    @property
    def far(self) -> bool:
        """Whether the file is so far from what was solved that poses beside are solved near no fold too."""
        return self.rounded and max(self.dh.deviation) > FAR

    @property
    def guarded(self) -> bool:
        """Whether the guards alone make rows come and go: the Program calls no routine for roots."""
        return self.plan is None and all(level.call is None for level in self.program.levels)

    @property
    def max_solutions(self) -> int:
        """Rows of the solution at most (two whole turns of a joint count once)."""
        return most_rows(self.lanes, self.rounded)

    @property
    def lanes(self) -> int:
        """Rows of the closed form at most."""
        return self.program.max_solutions

    @property
    def reads(self) -> Task:
        """What of the pose counts."""
        return find_task(self.task)

    @property
    def freedoms(self) -> int:
        """How many freedoms of the whole pose all joints move together, those that are held too: fewer than
        they are and six where joints are held as the others move the same without them, as in a plane."""
        dof, held = self.dh.dof, self.dh.free
        if not (self.reads.whole_pose and held and dof - len(held) < 6):
            return min(dof, 6)
        return freedoms_moved(replace(self.dh, free=()), self.reads)

    @property
    def unit_columns(self) -> tuple[int, ...]:
        """Columns of the rotation that the entries of the task make up, and that are unit vectors."""
        task = self.reads
        level = task.orientation == "yaw" and keeps_heading_level(self.dh, task.axis)
        if task.orientation == "direction" or level:
            return (AXES.index(task.axis),)
        return (0, 1, 2) if task.orientation == "rotation" else ()

    @property
    def size(self) -> float:
        """Length (m) that errors of position are taken relative to: 1 but for large and tiny arms."""
        return position_unit(self.dh)

    def period(self, joint: int) -> float:
        """How far apart (rad) values of the joint are that are the same configuration; 0 where none are."""
        return period_of(self.dh, joint)
