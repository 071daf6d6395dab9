"""The Program: what every emitted language is written from.

Levels nest: level 0 runs once a pose; each further level runs once for every branch of every level
before it. Depth first that is nested loops; breadth first it is arrays that grow by the number of
branches at each level. Both give the same solutions in the same order.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

from ikgen.model.angle_function import AngleFunction
from ikgen.program.inputs import Input
from ikgen.program.ops import Operand
from ikgen.program.routines import Routine

__all__ = [
    "Call", "Comment", "Constant", "Entries", "JointOutput", "Let", "Level", "Program", "Require",
    "Statement",
]  # fmt: skip

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Let:
    """`name = value`; `boolean` for conditions."""

    name: str
    value: Operand
    boolean: bool = False


@dataclass(frozen=True, slots=True)
class Require:
    """The branch has no solution unless the condition holds; `fold`: where it ceases to, two solutions meet
    and vanish."""

    condition: Operand
    fold: bool = False


@dataclass(frozen=True, slots=True)
class Comment:
    """A line for the reader: which unknown comes next, and where its equation is from."""

    text: str


Statement = Let | Require | Comment


@dataclass(frozen=True, slots=True)
class Call:
    """A bigger routine that gives the branches of a level: `names` are set for each of its roots, as the
    routine says. `ikgen.program.routines.ROUTINES` are all that there are."""

    routine: Routine
    arguments: tuple[Operand, ...]
    names: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Level:
    """One nesting level: `branches` alternatives, told apart by `sigma` = +1, -1 or by a `call`; `solved`
    are the names of what sigma decides (a cosine and sine, or a distance): equal where branches meet. What
    several sigmas decide is solved at the level of the last."""

    branches: int
    sigma: str | None
    call: Call | None
    body: tuple[Statement, ...]
    solved: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Constant:
    """A named number of the arm: a length (m), or the cosine or sine of an angle, which `function` says."""

    name: str
    value: float
    function: AngleFunction | None = None


@dataclass(frozen=True, slots=True)
class JointOutput:
    """A joint's value (rad or m, as the file counts it); revolute ones in (-pi, pi]."""

    joint: int
    value: Operand


Entries = tuple[tuple[Operand, ...], ...]
"""Rotation and position of a frame: three rows of four operands, constants of the arm."""


@dataclass(frozen=True, slots=True)
class Program:
    """Closed-form solver of one chain.

    `parameters` are the arm's constants, `constants` what follows from them alone. `inputs` are what a
    caller hands over and the Program reads; `prelude` is what follows from the inputs of joints
    alone: it runs once a solve. `singular` are the conditions under which a solution is one of a continuum,
    or a branch that fails may have one in the file's geometry; `doubts` those under which the file's
    geometry may have more solutions near it;
    `residuals` the squared errors (m^2, rad^2) with which a row reproduces the pose. `frames` are the
    constant transforms of the file's own chain, `T = F_0 M_1 F_1 ... M_n F_n` with M_i the motion of row i.
    `coarse`: round-off alone moves rows at most poses by more than they may be off.
    """

    name: str
    parameters: tuple[Constant, ...]
    constants: tuple[Let, ...]
    inputs: tuple[Input, ...]
    prelude: tuple[Let, ...]
    levels: tuple[Level, ...]
    outputs: tuple[JointOutput, ...]
    singular: tuple[str, ...]
    residuals: tuple[str, ...] = ()
    frames: tuple[Entries, ...] = ()
    coarse: bool = False
    doubts: tuple[str, ...] = ()

    @property
    def max_solutions(self) -> int:
        """Number of branches of the innermost level."""
        count = 1
        for level in self.levels:
            count *= level.branches
        return count

    @property
    def routines(self) -> tuple[Routine, ...]:
        """The routines that are called, each once, by name."""
        called = {level.call.routine for level in self.levels if level.call is not None}
        return tuple(sorted(called, key=lambda one: one.name))

    def inputs_of(self, kind: type[T]) -> tuple[T, ...]:
        """The inputs of a kind, in order."""
        return tuple(one for one in self.inputs if isinstance(one, kind))
