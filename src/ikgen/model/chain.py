"""A serial chain from base link to tip link, before any convention is imposed on it."""

from __future__ import annotations

from dataclasses import dataclass

from ikgen.model.arrays import Array
from ikgen.model.joint_tree import Limits

__all__ = ["MOST_AXES", "PRISMATIC", "REVOLUTE", "ActuatedJoint", "Chain", "ChainAxis"]

MOST_AXES = 16
"""The most moving axes of a chain; each more takes a derivation half as long again."""

REVOLUTE = "revolute"
PRISMATIC = "prismatic"


@dataclass(frozen=True, slots=True)
class ActuatedJoint:
    """One independent joint variable. `kind` is "revolute" or "prismatic"; `limits` in rad or m."""

    name: str
    kind: str
    limits: Limits
    continuous: bool = False


@dataclass(frozen=True, slots=True)
class ChainAxis:
    """One moving axis of the chain.

    `T_prev_axis` (4, 4) is this axis' joint frame in the previous axis' joint frame (in the base link's
    for the first) at value 0, with the joint moving about or along the unit vector `axis` (3,) of its
    own frame. Its value is `multiplier * q[driver] + offset`: driver indexes `Chain.joints`; multiplier
    and offset are 1 and 0 but for mimic joints.
    """

    name: str
    kind: str
    T_prev_axis: Array
    axis: Array
    driver: int
    multiplier: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True, slots=True)
class Chain:
    """`T_base_tip(q) = prod_i(T_prev_axis_i * Motion_i) * T_last_tip`, joints listed base to tip.

    Joints that were locked are constants inside the transforms and not listed; `locked` names them.
    `file_axes` are those of the file where linkages of several are one of `axes`, empty otherwise.
    """

    robot: str
    base_link: str
    tip_link: str
    joints: tuple[ActuatedJoint, ...]
    axes: tuple[ChainAxis, ...]
    T_last_tip: Array
    locked: tuple[tuple[str, float], ...] = ()
    file_axes: tuple[ChainAxis, ...] = ()

    @property
    def dof(self) -> int:
        """Number of independent joint variables."""
        return len(self.joints)
