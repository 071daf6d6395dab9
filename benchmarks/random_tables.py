"""Random modified DH tables whose joints are independent, and their text for the command line."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from ikgen.equations.probes import arm_size, smallest_singular
from ikgen.kinematics.rigid import dh_link
from ikgen.model.chain import PRISMATIC, REVOLUTE, ActuatedJoint
from ikgen.model.dh import Angle, DHChain, DHRow, Length
from ikgen.model.joint_tree import Limits

__all__ = ["Drawn", "pattern", "random_table", "table_text"]

QUARTERS = (Fraction(0), Fraction(1, 2), Fraction(-1, 2))
_STRAIGHT = Angle(0.0, Fraction(0))
_NONE = Length(0.0, None)
_SLIDING = 0.25


@dataclass(frozen=True, slots=True)
class Drawn:
    """What is drawn: from `least` to `most` joints, `slides` of them prismatic (None: a quarter, by
    chance), with twists (of slides theta too) of 0 and ±90 degrees and half of the lengths zero, or of
    `any_angle` and few lengths zero."""

    least: int = 3
    most: int = 6
    slides: int | None = None
    any_angle: bool = False


def random_table(rng: np.random.Generator, drawn: Drawn = Drawn()) -> DHChain:
    """A chain whose joints move its tip independently of each other."""
    while True:
        dh = _draw(rng, drawn)
        values = rng.uniform(-2.0, 2.0, (6, dh.dof))
        if np.median(smallest_singular(dh, values, arm_size(dh))) > 1e-3:
            return dh


def _draw(rng: np.random.Generator, drawn: Drawn) -> DHChain:
    rows: list[DHRow] = []
    joints: list[ActuatedJoint] = []
    for i, kind in enumerate(_kinds(rng, drawn)):
        turns = kind == REVOLUTE
        alpha = _twist(rng, drawn) if i else _STRAIGHT
        a = _length(rng, f"a_{i}", 0.2 if drawn.any_angle else 0.5) if i else _NONE
        d = _length(rng, f"d_{i + 1}", 0.2 if drawn.any_angle else 0.6)
        offset: Angle | Length = _STRAIGHT if turns else _NONE
        placed, theta = (d, _STRAIGHT) if turns else (_NONE, _twist(rng, drawn))
        rows.append(DHRow(f"q{i + 1}", kind, alpha, a, placed, theta, i, 1.0, offset))
        joints.append(ActuatedJoint(f"q{i + 1}", kind, Limits(-np.inf, np.inf)))
    eye = np.eye(4)
    return DHChain("random", "base", "tip", tuple(joints), tuple(rows), eye, eye, _frames(rows))


def _kinds(rng: np.random.Generator, drawn: Drawn) -> list[str]:
    n = int(rng.integers(drawn.least, drawn.most + 1))
    if drawn.slides is None:
        return [PRISMATIC if rng.random() < _SLIDING else REVOLUTE for _ in range(n)]
    sliding = set(rng.permutation(n)[: drawn.slides].tolist())
    return [PRISMATIC if i in sliding else REVOLUTE for i in range(n)]


def _twist(rng: np.random.Generator, drawn: Drawn) -> Angle:
    if drawn.any_angle:
        return Angle(float(rng.uniform(-np.pi, np.pi)), None)
    twist = QUARTERS[int(rng.integers(3))]
    return Angle(float(twist) * np.pi, twist)


def _length(rng: np.random.Generator, name: str, zero: float) -> Length:
    if rng.random() < zero:
        return _NONE
    return Length(float(rng.uniform(0.2, 1.0)), name)


def _frames(rows: Sequence[DHRow]) -> tuple[np.ndarray, ...]:
    """`F_0 ... F_n` of the table itself."""
    frames = [np.eye(4)]
    for row in rows:
        frames[-1] = frames[-1] @ dh_link(row.alpha.value, row.a.value, 0.0, 0.0)
        frames.append(dh_link(0.0, 0.0, row.theta.value, row.d.value))
    return tuple(frames)


def table_text(dh: DHChain, name: str) -> str:
    """The chain as a file for `ikgen from-dh`."""
    out = [f'name = "{name}"', 'convention = "modified"']
    for row in dh.rows:
        out += [
            "[[joints]]",
            f'type = "{"revolute" if row.revolute else "prismatic"}"',
            f"alpha = {_angle_text(row.alpha)}",
            f"a = {row.a.value!r}",
            f"d = {row.d.value!r}",
            f"theta = {_angle_text(row.theta)}",
        ]
    return "\n".join(out) + "\n"


def _angle_text(angle: Angle) -> str:
    exact = angle.exact
    if exact is None:
        return repr(angle.value)
    return f'"{exact.numerator}*pi/{exact.denominator}"'


def pattern(dh: DHChain) -> str:
    """Joint types with what lies between them: = parallel, | at right angles, / else, o no offset."""
    text = ""
    for row in dh.rows:
        text += "=" if row.alpha.exact == 0 else "/" if row.alpha.exact is None else "|"
        text += "o" if row.a.name is None else "a"
        text += ("R" if row.revolute else "P") + ("" if row.d.name is None else "d")
    return text[2:]
