"""What the names of links and joints say about them, by the habits of published descriptions."""

from __future__ import annotations

import re

__all__ = [
    "NO_RANK",
    "base_rank",
    "is_finger",
    "is_finger_link",
    "is_finger_part",
    "is_head",
    "is_rotor",
    "is_sensor",
    "is_wheel",
    "tip_rank",
]

_FINGER_JOINT = re.compile(
    r"finger|gripper|grip_|jaw|knuckle|claw|(^|_)grasp(_joint)?$|^[lr]_?hand$"
    r"|(^|_)(thumb|index|middle|ring|little|pinky)(_|\d|$)",
    re.IGNORECASE,
)
_FINGER_LINK = re.compile(r"finger|knuckle|moving[-_](part|jaw)", re.IGNORECASE)
_FINGER_PART = re.compile(rf"{_FINGER_LINK.pattern}|jaw|thumb", re.IGNORECASE)
_WHEEL = re.compile(r"wheel|caster|castor", re.IGNORECASE)
_ROTOR = re.compile(r"rotor|propeller", re.IGNORECASE)
_HEAD = re.compile(r"head|neck|cervical|(^|[/_])eyes?(_|$)", re.IGNORECASE)
_SENSOR = re.compile(
    r"camera|optical|realsense|imu|sensor|touch|marker|aruco|apriltag|fiducial|contact|collision|inertia"
    r"|balancing",
    re.IGNORECASE,
)

# A mount of an arm on a bigger robot (arm_base_link) is not that robot's base.
_BASES = (
    re.compile(r"(^|[/_])(?<!arm_)base_link$"),
    re.compile(r"(^|[/_])link_base$"),
    re.compile(r"[/_]link0$", re.IGNORECASE),
)
_TIPS = (
    re.compile(r"(^|[/_])tool_?\d$"),
    re.compile(r"(^|[/_])tcp$", re.IGNORECASE),
    re.compile(r"(^|[/_])(tool_frame|(gripper|grasp)_cent(er|re)|ee_gripper_link)$", re.IGNORECASE),
    re.compile(r"(^|[/_])flange$", re.IGNORECASE),
    re.compile(r"(^|[/_])(ee_link|link_eef?|ee|end_link)$|end_effector", re.IGNORECASE),
    re.compile(r"^(arm_(left_|right_)?)?tool_link$", re.IGNORECASE),
)
NO_RANK = max(len(_BASES), len(_TIPS))
"""The rank of a name that follows no convention."""


def is_finger(joint: str, child: str) -> bool:
    """Whether the names of a joint and the link it holds tell of a gripper's finger."""
    return _FINGER_JOINT.search(joint) is not None or is_finger_link(child)


def is_finger_link(link: str) -> bool:
    """Whether a link's name tells of a part of a finger."""
    return _FINGER_LINK.search(link) is not None


def is_finger_part(name: str) -> bool:
    """Whether the name of a joint or link tells of one finger, not of all of a gripper."""
    return _FINGER_PART.search(name) is not None


def is_wheel(joint: str, child: str) -> bool:
    """Whether the names of a joint and the link it holds tell of a wheel or caster."""
    return _WHEEL.search(joint) is not None or _WHEEL.search(child) is not None


def is_rotor(joint: str, child: str) -> bool:
    """Whether the names of a joint and the link it holds tell of a rotor: a propeller, or a motor's."""
    return _ROTOR.search(joint) is not None or _ROTOR.search(child) is not None


def is_head(joint: str) -> bool:
    """Whether a joint's name tells that it turns a head."""
    return _HEAD.search(joint) is not None


def is_sensor(link: str) -> bool:
    """Whether a link's name tells that it marks a sensor or a simulator's aid, not a tool."""
    return _SENSOR.search(link) is not None


def base_rank(link: str) -> int:
    """How conventional a name is for the base of an arm: 0 best, `NO_RANK` for no such name."""
    return _rank(link, _BASES)


def tip_rank(link: str) -> int:
    """How conventional a name is for the tip of an arm: tool0, tcp, tool, flange, end effector."""
    return _rank(link, _TIPS)


def _rank(link: str, patterns: tuple[re.Pattern[str], ...]) -> int:
    return next((i for i, pattern in enumerate(patterns) if pattern.search(link)), NO_RANK)
