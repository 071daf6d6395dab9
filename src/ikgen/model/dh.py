"""The chain in modified Denavit-Hartenberg form (Craig, Introduction to Robotics, ch. 3).

`A_i = Rx(alpha) Tx(a) Rz(theta) Tz(d)` with alpha and a the link's twist and length before joint i
(alpha_{i-1}, a_{i-1} in Craig's notation), and `T_base_tip = X_base * A_1 ... A_n * X_tip`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction

from ikgen.model.arrays import Array
from ikgen.model.chain import REVOLUTE, ActuatedJoint
from ikgen.model.gear_ratio import common_share, is_whole
from ikgen.model.joint_tree import Limits
from ikgen.model.transmission import Transmission

__all__ = [
    "ARM_ANGLE_IDENTIFIER",
    "ARM_ANGLE_OPTION",
    "Angle",
    "DHChain",
    "DHRow",
    "Length",
    "Snap",
]

ARM_ANGLE_OPTION = "arm-angle"
"""What is held in place of a joint of an arm with a spherical shoulder and a spherical wrist, as options
and configs spell it."""

ARM_ANGLE_IDENTIFIER = "arm_angle"
"""The same as emitted code spells it among the names of held joints."""

_ANGLE = ActuatedJoint(ARM_ANGLE_OPTION, REVOLUTE, Limits(-math.pi, math.pi))
"""It as something that turns."""


@dataclass(frozen=True, slots=True)
class Angle:
    """A constant angle in rad. `exact` is its multiple of pi where it is a multiple of pi/12, in
    (-1, 1]; otherwise `name` is its symbol (`alpha_2`). `symbolic` as in `Length`. `near` is the
    multiple of pi that an angle with a symbol is the rounded value of, if it is one."""

    value: float
    exact: Fraction | None
    name: str | None = None
    symbolic: bool = False
    near: Fraction | None = None

    @property
    def rounded(self) -> bool:
        """Whether it is kept as the file has it although another value was meant."""
        return self.near is not None

    @property
    def nominal(self) -> float:
        """The angle (rad) that was meant: of a rounded one the multiple of pi/12."""
        return self.value if self.near is None else float(self.near) * math.pi


@dataclass(frozen=True, slots=True)
class Length:
    """A constant length in m: `sign * symbol` with the symbol's value attached; exact zero has no name.

    `value` is the signed value (`sign` times the symbol's); two lengths equal up to sign share one
    `name`. Without numbers (a symbolic table) `symbolic` is true and `value` is a random generic number
    to probe with. `stray`: a length that was meant to be zero and is kept as the file has it.
    """

    value: float
    name: str | None
    sign: int = 1
    symbolic: bool = False
    stray: bool = False

    @property
    def rounded(self) -> bool:
        """Whether it is kept as the file has it although zero was meant."""
        return self.stray

    @property
    def nominal(self) -> float:
        """The length (m) that was meant: of a stray one zero."""
        return 0.0 if self.stray else self.value


@dataclass(frozen=True, slots=True)
class DHRow:
    """One row. The variable (theta of a revolute row, d of a prismatic one) is
    `scale * q[driver] + offset` with scale = ±1 but for mimic joints, and offset an `Angle` for
    revolute rows, a `Length` for prismatic ones. `d` is the constant d of a revolute row, `theta` the
    constant theta of a prismatic row; the other of the two is exact zero."""

    name: str
    kind: str
    alpha: Angle
    a: Length
    d: Length
    theta: Angle
    driver: int
    scale: float
    offset: Angle | Length

    @property
    def revolute(self) -> bool:
        """Whether the row's variable is an angle."""
        return self.kind == REVOLUTE


@dataclass(frozen=True, slots=True)
class Snap:
    """One constant of the chain that was replaced by an exact one: what, from, to (rad or m)."""

    what: str
    before: float
    after: float

    @property
    def texts(self) -> tuple[str, str]:
        """The two numbers in as many digits as tell them apart, 12 at least."""
        for digits in (12, 15, 17):
            before, after = f"{self.before:.{digits}g}", f"{self.after:.{digits}g}"
            if before != after:
                break
        return before, after


@dataclass(frozen=True, slots=True)
class DHChain:
    """A chain in modified DH form with exact geometry, and the file's own geometry beside it.

    `X_base`, `X_tip` (4, 4): constant transforms at the ends. `file_frames`: n + 1 constant transforms
    (4, 4), the file's own chain to round-off: `T = F_0 M_1(v_1) F_1 ... M_n(v_n) F_n` with `v_i` the DH
    variable of row i (offset included) and `M` = Rz or Tz. `deviation` is the largest difference
    between the two over random configurations: (m, rad). `transmission` is between motors and joints
    where each joint has no motor of its own; all else here, limits too, is of the joints. `written` has
    symbols that are not the file's own names for what they stand for, with that.
    """

    robot: str
    base_link: str
    tip_link: str
    joints: tuple[ActuatedJoint, ...]
    rows: tuple[DHRow, ...]
    X_base: Array
    X_tip: Array
    file_frames: tuple[Array, ...]
    snaps: tuple[Snap, ...] = ()
    deviation: tuple[float, float] = (0.0, 0.0)
    free: tuple[str, ...] = ()
    locked: tuple[tuple[str, float], ...] = ()
    transmission: Transmission | None = None
    written: tuple[tuple[str, str], ...] = ()

    @property
    def dof(self) -> int:
        """Number of independent joint variables."""
        return len(self.joints)

    @property
    def most_driven(self) -> float:
        """How far the rows of one joint move together, at most, where it moves by 1; at least 1."""
        driven = [0.0] * self.dof
        for row in self.rows:
            driven[row.driver] += abs(row.scale)
        return max(1.0, *driven)

    @property
    def arm_angle(self) -> bool:
        """Whether the arm angle is held, in place of a joint."""
        return ARM_ANGLE_OPTION in self.free and all(
            j.name != ARM_ANGLE_OPTION for j in self.joints
        )

    @property
    def free_indices(self) -> tuple[int, ...]:
        """Places among `joints` of those that are held."""
        return tuple(j for j, joint in enumerate(self.joints) if joint.name in self.free)

    @property
    def moving(self) -> int:
        """How many joints move independently: what is held takes one each, the arm angle too."""
        return self.dof - len(self.free)

    @property
    def held_inputs(self) -> tuple[ActuatedJoint, ...]:
        """What is held, in the order in which emitted code takes the values: joints, and after them the
        arm angle, which turns once around."""
        joints = tuple(self.joints[j] for j in self.free_indices)
        return (*joints, _ANGLE) if self.arm_angle else joints

    @property
    def held(self) -> tuple[str, ...]:
        """Names of `held_inputs` in emitted code."""
        return tuple(ARM_ANGLE_IDENTIFIER if x is _ANGLE else x.name for x in self.held_inputs)

    @property
    def symbols(self) -> tuple[str, ...]:
        """Names of lengths and angles without numbers; such a chain can be derived, not emitted."""
        names = {x.name: None for x in self.constants() if x.symbolic and x.name is not None}
        return tuple(names)

    @property
    def symbol_words(self) -> str:
        """The `symbols` in a line, each with what it stands for where that is not its name."""
        written = dict(self.written)
        words = (f"{name} = {written[name]}" if name in written else name for name in self.symbols)
        return ", ".join(words)

    def constants(self) -> Iterator[Angle | Length]:
        """The constants of all rows, base to tip, also zeros and multiples of pi, which have no names."""
        for row in self.rows:
            yield from (row.alpha, row.a, row.d, row.theta, row.offset)

    def named_constants(self, *, offsets: bool = True) -> dict[str, float]:
        """Name -> value (rad or m, of a length without its sign) in the order of the rows, where these have
        no exact one; a number to probe with for those of `symbols`. `offsets`: also those of variables."""
        found: dict[str, float] = {}
        for row in self.rows:
            for x in (row.alpha, row.a, row.d, row.theta, *([row.offset] if offsets else [])):
                if x.name is not None:
                    value = x.sign * x.value if isinstance(x, Length) else x.value
                    found.setdefault(x.name, value)
        return found

    def lead_row(self, joint: int) -> DHRow:
        """The row whose variable stands for a joint: the first of those that it moves least, so that the
        others turn a whole number of times as far; where they do not, that row with the share of its turn
        of which all turn whole multiples."""
        rows = [row for row in self.rows if row.driver == joint]
        least = min(rows, key=lambda row: abs(row.scale))
        if len(rows) == 1 or not least.revolute:
            return least
        share = common_share([row.scale / least.scale for row in rows])
        if share == 1:
            return least
        return replace(least, scale=least.scale / share, offset=Angle(0.0, Fraction(0)))

    def follows(self, row: DHRow) -> tuple[float, float]:
        """How the row's variable follows that of its joint: `ratio * v + shift` (rad or m)."""
        lead = self.lead_row(row.driver)
        ratio = row.scale / lead.scale
        if row.revolute and is_whole(ratio):
            ratio = float(round(ratio))
        return ratio, row.offset.value - ratio * lead.offset.value
