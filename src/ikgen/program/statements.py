"""The Program: what every emitted language is written from.

Levels nest: level 0 runs once a pose; each further level runs once for every branch of every level
before it. Depth first that is nested loops; breadth first it is arrays that grow by the number of
branches at each level. Both give the same solutions in the same order.
"""

from __future__ import annotations

from dataclasses import dataclass

from ikgen.program.ops import Operand

__all__ = ["Call", "Comment", "JointOutput", "Let", "Level", "Program", "Require", "Statement"]


@dataclass(frozen=True, slots=True)
class Let:
    """`name = value`; `boolean` for conditions."""

    name: str
    value: Operand
    boolean: bool = False


@dataclass(frozen=True, slots=True)
class Require:
    """The branch has no solution unless the condition holds."""

    condition: Operand


@dataclass(frozen=True, slots=True)
class Comment:
    """A line for the reader: which unknown comes next, and where its equation is from."""

    text: str


Statement = Let | Require | Comment


@dataclass(frozen=True, slots=True)
class Call:
    """A bigger routine that gives the branches of a level: `names` are set for each of its roots."""

    routine: str
    arguments: tuple[Operand, ...]
    names: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Level:
    """One nesting level: `branches` alternatives, told apart by `sigma` = +1, -1 or by a `call`."""

    branches: int
    sigma: str | None
    call: Call | None
    body: tuple[Statement, ...]


@dataclass(frozen=True, slots=True)
class JointOutput:
    """A joint's DH variable: its cosine and sine, or its distance (`sine` is 0 then)."""

    joint: int
    revolute: bool
    cosine: Operand
    sine: Operand


@dataclass(frozen=True, slots=True)
class Program:
    """Closed-form solver of one chain.

    `parameters` are the arm's constants, `constants` what follows from them alone. `inputs` are the
    raw pose entries `t00` ... `t23`, then per joint the seed values that a singular pose takes
    (`seed_c1`, `seed_s1` or `seed_d1`) and the held joints' values (`c7`, `s7` or `d7`).
    `singular` are the conditions under which a solution is one of a continuum; `residuals`
    the squared errors (m^2, rad^2) with which a row reproduces the pose.
    """

    name: str
    parameters: tuple[tuple[str, float], ...]
    constants: tuple[Let, ...]
    inputs: tuple[str, ...]
    levels: tuple[Level, ...]
    outputs: tuple[JointOutput, ...]
    singular: tuple[str, ...]
    residuals: tuple[str, ...] = ()

    @property
    def max_solutions(self) -> int:
        """Number of branches of the innermost level."""
        count = 1
        for level in self.levels:
            count *= level.branches
        return count
