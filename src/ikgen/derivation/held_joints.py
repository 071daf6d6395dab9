"""Which joints to hold of an arm with more of them than its task fixes, ranked before any derivation.

Joints that hardly move are held before all others: solved for, they are inside their limits at hardly any
pose. Then the ranking is by the closed form that the geometry lets expect (`ikgen.kinematics.form_class`),
then by the range of the held joints inside their limits, then by how well the joints that move do the task,
which decides where ranges are much the same: of an arm with two spherical joints the last joint may turn a
little farther than the others, and held it leaves an arm that is near a singularity several times as often.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ikgen.emit.derivation import Reading
    from ikgen.model.arrays import Array
    from ikgen.model.chain import ActuatedJoint
    from ikgen.model.dh import DHChain
    from ikgen.tasks import Task

__all__ = ["DIVIDING", "NEARBY", "HeldChoice", "held_choices", "nearby"]

NEARBY = 5e-4
"""Lengths (m) that may count as zero where the file's own geometry has no closed form: Newton steps on
the file's chain follow (offsets of 0.2 mm in a wrist that is meant to be spherical are real)."""

DIVIDING = 1e-4
"""Lengths over the arm's that may count as zero where a quartic takes them in: its roots lie in pairs as
close as that, and what follows divides by it, so that rows are off by round-off over its square."""

_WIDE = 0.9
"""Share of the widest range of the held joints: from there on it is much the same."""

_POOR = 0.3
"""Choices of a class that are conditioned worse than its best by this factor, or whose joints reach as much
less, as a wrist does that moves the tool alone, come last in it."""

_FEEBLE = 0.05
"""Choices that are conditioned worse than the best of all classes by this factor come after all others: of
a slide and a wrist that are held together few poses are left, however simple their closed form."""

_LOOKED_AT = 128
"""Configurations at which the conditioning is looked at; fewer of them where there are many choices."""

_FEWEST, _IN_ALL = 8, 2**15
"""Fewest configurations per choice, and most over all choices together."""

_LEADING = 16
"""So many choices, those that come first, are looked at with their held joints at the defaults too."""


@dataclass(frozen=True, slots=True)
class HeldChoice:
    """Joints `held` beside those that were asked for, base to tip, and the chain `dh` with them held.

    `form` indexes `FORM_WORDS`; `near` tells that it is that of the geometry nearby, better than the
    file's own. `span` is what the held joints' limits leave them, in turns and lengths of the arm;
    `condition` the geometric mean of smallest over largest singular value of what moves, over
    configurations inside the limits, half of them with the held joints at their defaults: one that is
    near a singularity more often has less. `volume` is the mean of the product of all singular values,
    of how much of the task's space small motions fill. `poor`: whether it has far less of either than the
    best of its class; `feeble`: whether it is conditioned far worse than the best of all classes. `idle`
    are those of `held` that hardly move.
    """

    held: tuple[str, ...]
    dh: DHChain
    form: int
    span: float
    condition: float
    volume: float
    near: bool = False
    poor: bool = False
    feeble: bool = False
    idle: tuple[str, ...] = ()

    @property
    def words(self) -> str:
        """Their names."""
        return " and ".join(self.held)

    @property
    def class_words(self) -> str:
        """The class of its closed form."""
        from ikgen.kinematics.form_class import FORM_WORDS

        return FORM_WORDS[self.form]

    @property
    def ranking(self) -> str:
        """What the choice is ranked by, in order."""
        near = ", of the geometry nearby" if self.near else ""
        measures = f"held range {self.span:.2g}; conditioning {self.condition:.2g}"
        first = f"hardly moves: {' and '.join(self.idle)}; " if self.idle else ""
        return f"{first}class: {self.class_words}{near}; {measures}"

    def behind(self, taken: HeldChoice) -> str:
        """What puts it behind the choice that was taken; "" where it was before that."""
        if len(self.idle) != len(taken.idle):
            solved = [name for name in taken.idle if name not in self.idle]
            return f"solves for {' and '.join(solved)}" if len(self.idle) < len(taken.idle) else ""
        if self.feeble != taken.feeble:
            return "worse conditioned" if self.feeble else ""
        if (self.form, self.near) != (taken.form, taken.near):
            later = (self.form, self.near) > (taken.form, taken.near)
            return self.class_words if later else ""
        if self.poor != taken.poor:
            words = "worse conditioned" if self.condition < taken.condition else "less reach"
            return words if self.poor else ""
        narrower = self.span < taken.span
        if min(self.span, taken.span) < _WIDE * max(self.span, taken.span):
            return "a narrower range" if narrower else ""
        if self.condition != taken.condition:
            return "worse conditioned" if self.condition < taken.condition else ""
        return "a narrower range" if narrower else ""


def nearby(reading: Reading, short: float = NEARBY) -> DHChain | None:
    """The chain in DH form with offsets up to `short` (m) taken as zero; None for a table."""
    from ikgen.kinematics.modified_dh import to_dh

    if reading.chain is None:
        return None
    near = to_dh(reading.chain, free=reading.dh.free, length_tolerance=short)
    return replace(near, transmission=reading.dh.transmission)


def held_choices(reading: Reading, task: Task) -> tuple[HeldChoice, ...]:
    """Every way to hold as many joints as are spare so that the others still do the task, best first;
    none where no joint is spare.

    Of one class, the file's own geometry comes before the one nearby, and choices that leave the others
    far worse conditioned than the best come last: an elbow that is held leaves the arm a shell to reach.
    """
    from ikgen.tasks.fitting import rank, scaled_motion

    dh = reading.dh
    motion, moving = scaled_motion(dh, task), _moving(dh)
    moved = rank(_singular(motion, [moving])[0])
    spare = len(moving) - moved - int(dh.arm_angle)
    if not spare or not moved:
        return ()
    subsets = [list(kept) for kept in itertools.combinations(moving, moved)]
    measured = zip(subsets, _singular(motion, subsets), strict=True)
    able = [kept for kept, ratios in measured if rank(ratios) == moved]
    if not able:
        return ()
    inside = _inside(dh)
    everywhere = scaled_motion(dh, task, inside[: max(_FEWEST, _IN_ALL // len(able))])
    full = [(kept, *_measures(everywhere[:, :, kept])) for kept in able]
    found = _ranked(dh, full)
    other = nearby(reading)
    if other is not None and other.rows != dh.rows:
        pairs = zip(found, _ranked(other, full), strict=True)
        found = [replace(a, form=b.form, near=True) if b.form < a.form else a for a, b in pairs]
    ranked = _sorted(found)
    return tuple(_sorted(_by_default(ranked[:_LEADING], task, inside)) + ranked[_LEADING:])


def _sorted(choices: Sequence[HeldChoice]) -> list[HeldChoice]:
    """Best first."""
    best: dict[tuple[int, int], tuple[float, float]] = {}
    top: dict[int, float] = {}
    for one in choices:
        top[len(one.idle)] = max(one.condition, top.get(len(one.idle), 0.0))
        condition, volume = best.get(_class(one), (0.0, 0.0))
        best[_class(one)] = max(one.condition, condition), max(one.volume, volume)

    def poor(one: HeldChoice) -> bool:
        condition, volume = best[_class(one)]
        return one.condition < _POOR * condition or one.volume < _POOR * volume

    def feeble(one: HeldChoice) -> bool:
        return one.condition < _FEEBLE * top[len(one.idle)]

    found = [replace(one, poor=poor(one), feeble=feeble(one)) for one in choices]

    def group(one: HeldChoice) -> tuple[int, bool, int, bool, bool]:
        return -len(one.idle), one.feeble, one.form, one.near, one.poor

    widest: dict[tuple[int, bool, int, bool, bool], float] = {}
    for one in found:
        widest[group(one)] = max(one.span, widest.get(group(one), 0.0))

    def key(one: HeldChoice) -> tuple[object, ...]:
        within = min(one.span, _WIDE * widest[group(one)])
        names = [joint.name for joint in one.dh.joints]
        from_tip = [-names.index(name) for name in reversed(one.held)]
        return *group(one), -within, -one.condition, -one.span, from_tip

    return sorted(found, key=key)


def _class(one: HeldChoice) -> tuple[int, int]:
    """What choices are compared within: as many joints held that hardly move, and one closed form."""
    return -len(one.idle), one.form


def _ranked(dh: DHChain, kept: Sequence[tuple[Sequence[int], float, float]]) -> list[HeldChoice]:
    """A choice for each set of joints that move, by index, with its condition and volume."""
    from ikgen.kinematics.axis_relations import axis_relations, reach
    from ikgen.kinematics.form_class import form_class
    from ikgen.kinematics.idle_joints import idle_joints

    relations, length, idle = axis_relations(dh), reach(dh), idle_joints(dh)
    found = []
    for joints, condition, volume in kept:
        rows = [i for i, row in enumerate(dh.rows) if row.driver in joints]
        held = [j for j in _moving(dh) if j not in joints]
        names = tuple(dh.joints[j].name for j in held)
        found.append(
            HeldChoice(
                names,
                replace(dh, free=(*dh.free, *names)),
                form_class(dh.rows, rows, relations),
                round(sum(_span(dh.joints[j], length) for j in held), 6),
                float(f"{condition:.2g}"),
                float(f"{volume:.2g}"),
                idle=tuple(name for name in names if name in idle),
            )
        )
    return found


def _span(joint: ActuatedJoint, length: float) -> float:
    """The range inside the limits, in turns or lengths of the arm, at most 1."""
    width = joint.limits.upper - joint.limits.lower
    return min(width / (2.0 * math.pi if joint.kind == "revolute" else length), 1.0)


def _moving(dh: DHChain) -> list[int]:
    return [j for j, joint in enumerate(dh.joints) if joint.name not in dh.free]


def _singular(motion: Array, subsets: Sequence[Sequence[int]]) -> Array:
    """`motion_ratios` of each subset of the joints: (subsets, joints)."""
    import numpy as np

    from ikgen.tasks.fitting import motion_ratios

    return motion_ratios(np.stack([motion[:, :, list(columns)] for columns in subsets]))


def _inside(dh: DHChain) -> Array:
    """Configurations (_LOOKED_AT, dof) inside the limits, the same each time; at most half a turn, or the
    arm's length, from 0."""
    import numpy as np

    from ikgen.kinematics.axis_relations import reach
    from ikgen.kinematics.joint_box import joint_box

    low, high = joint_box(dh, reach(dh))
    share = np.random.default_rng(0).uniform(size=(_LOOKED_AT, dh.dof))
    return np.asarray(low + share * (high - low))


def _by_default(choices: Sequence[HeldChoice], task: Task, inside: Array) -> list[HeldChoice]:
    """With a conditioning to which configurations with the held joints at their defaults count as much as
    all others: that is how the arm is used without a seed."""
    import numpy as np

    from ikgen.kinematics.free_joints import free_defaults
    from ikgen.tasks.fitting import scaled_motion

    every = np.tile(inside, (len(choices), 1, 1))
    for q, choice in zip(every, choices, strict=True):
        q[:, list(choice.dh.free_indices)] = free_defaults(choice.dh, ())
    motions = np.split(scaled_motion(choices[0].dh, task, np.concatenate(every)), len(choices))
    out = []
    for choice, motion in zip(choices, motions, strict=True):
        default, _ = _measures(motion[:, :, _moving(choice.dh)])
        both = float(f"{math.sqrt(choice.condition * default):.2g}")
        out.append(replace(choice, condition=both))
    return out


def _measures(motion: Array) -> tuple[float, float]:
    """The geometric means over the samples of smallest over largest singular value, and of the product of
    all (Yoshikawa 1985, manipulability)."""
    import numpy as np

    values = np.linalg.eigvalsh(motion.transpose(0, 2, 1) @ motion)
    ratios = np.maximum(values[:, 0] / np.maximum(values[:, -1], 1e-24), 1e-24)
    volumes = np.log(np.maximum(values, 1e-24)).sum(axis=1)
    return float(np.exp(0.5 * np.log(ratios).mean())), float(np.exp(0.5 * volumes.mean()))
