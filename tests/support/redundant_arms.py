"""URDFs of arms with more joints than a pose has freedoms, of round numbers."""

from __future__ import annotations

from collections.abc import Sequence

__all__ = [
    "LIFT_SCARA",
    "NON_SPHERICAL_WRIST",
    "OFFSET_ELBOW",
    "SHOULDER_ELBOW_WRIST",
    "STATION_ARM",
    "STATION_INSPECTOR",
    "TORSO",
    "serial_urdf",
]

Joint = tuple[str, str, str, str, tuple[float, float]]
"""Name, type, axis, origin and limits."""

_TURN = (-2.9, 2.9)

SHOULDER_ELBOW_WRIST: tuple[Joint, ...] = (
    ("shoulder_yaw", "revolute", "0 0 1", "0 0 0.3", _TURN),
    ("shoulder_pitch", "revolute", "0 1 0", "0 0 0", (-2.0, 2.0)),
    ("shoulder_roll", "revolute", "0 0 1", "0 0 0", (-3.0, 3.0)),
    ("elbow", "revolute", "0 1 0", "0 0 0.4", (-2.1, 2.1)),
    ("wrist_yaw", "revolute", "0 0 1", "0 0 0.35", _TURN),
    ("wrist_pitch", "revolute", "0 1 0", "0 0 0", (-2.0, 2.0)),
    ("wrist_roll", "revolute", "0 0 1", "0 0 0", _TURN),
)
"""Two spherical joints with an elbow between them: the class of most arms with seven joints."""

OFFSET_ELBOW: tuple[Joint, ...] = (
    ("shoulder_yaw", "revolute", "0 0 -1", "0 0 0.3", _TURN),
    *SHOULDER_ELBOW_WRIST[1:3],
    ("elbow", "revolute", "0 1 0", "0.08 0 0.4", (-2.1, 2.1)),
    ("wrist_yaw", "revolute", "0 0 1", "-0.05 0 0.35", _TURN),
    *SHOULDER_ELBOW_WRIST[5:],
)
"""The same with the elbow's axis beside the links, as barrett's and yaskawa's arms have it, and the first
joint's axis downwards."""

LIFT_SCARA: tuple[Joint, ...] = (
    ("lift", "prismatic", "0 0 1", "0 0 0.3", (0.0, 0.9)),
    ("shoulder", "revolute", "0 0 1", "0.1 0 0", (-2.4, 2.4)),
    ("elbow", "revolute", "0 0 1", "0.3 0 0", (-2.6, 2.6)),
    ("quill", "prismatic", "0 0 -1", "0.25 0 0", (0.0, 0.2)),
    ("spin", "revolute", "0 0 1", "0 0 0", (-3.0, 3.0)),
)
"""Two slides on parallel axes, and a task that reads a heading: two entries that are one freedom."""

NON_SPHERICAL_WRIST: tuple[Joint, ...] = (
    ("base_yaw", "revolute", "0 0 1", "0 0 0.28", (-3.1, 3.1)),
    ("shoulder_pitch", "revolute", "0 1 0", "0 0.002 0", (-3.1, 3.1)),
    ("upper_roll", "revolute", "0 0 1", "0 0 0.41", (-3.1, 3.1)),
    ("elbow_pitch", "revolute", "0 1 0", "0 0.011 0", (-3.1, 3.1)),
    ("lower_roll", "revolute", "0 0 1", "0 0 0.25", (-3.1, 3.1)),
    ("wrist", "revolute", "0 0.8660254037844387 0.5", "0 0.0741 0.0428", (-3.1, 3.1)),
    ("hand", "revolute", "0 0.8660254037844387 -0.5", "0 0 0", (-3.1, 3.1)),
)
"""Neighbouring axes meet, the last three not in one point: curved wrists of 60 degrees."""

_BENDS = (-2.0, 2.0)
STATION_INSPECTOR: tuple[Joint, ...] = (
    ("pitch_1", "revolute", "1 0 0", "0 0 0.3", _BENDS),
    ("yaw_1", "revolute", "0 1 0", "0 0 0.25", _BENDS),
    ("roll_1", "revolute", "0 0 1", "0 0 0.4", (-3.1, 3.1)),
    ("elbow", "revolute", "1 0 0", "0 0 4", (0.0, 3.0)),
    ("roll_2", "revolute", "0 0 1", "0 0 4", (-3.1, 3.1)),
    ("yaw_2", "revolute", "0 1 0", "0 0 0.4", _BENDS),
    ("pitch_2", "revolute", "1 0 0", "0 0 0.25", _BENDS),
)
"""The same from either end, as arms that walk over a space station, with offsets between all axes."""

_ROUND = (-4.71, 4.71)
STATION_ARM: tuple[Joint, ...] = (
    ("roll_1", "revolute", "0 0 1", "0 0 0.38", _ROUND),
    ("yaw_1", "revolute", "0 1 0", "0 0 0.63", _ROUND),
    ("pitch_1", "revolute", "1 0 0", "0 0.63 0", _ROUND),
    ("elbow", "revolute", "1 0 0", "0.5 0 6.9", _ROUND),
    ("pitch_2", "revolute", "1 0 0", "0.5 0 6.9", _ROUND),
    ("yaw_2", "revolute", "0 1 0", "0 0.63 0", _ROUND),
    ("roll_2", "revolute", "0 0 1", "0 0 0.63", _ROUND),
)
"""Three parallel axes in the middle of long links."""

TORSO: Joint = ("torso", "prismatic", "0 0 1", "0 0 0.5", (0.0, 0.4))


def serial_urdf(name: str, joints: Sequence[Joint]) -> str:
    """A chain `base_link` to `tool0` of these joints, the tip 0.1 m beyond the last."""
    text, parent = '<link name="base_link"/>\n', "base_link"
    flange: Joint = ("flange", "fixed", "0 0 1", "0 0 0.1", (0.0, 0.0))
    for joint, kind, axis, xyz, (low, high) in (*joints, flange):
        child = "tool0" if kind == "fixed" else f"{joint}_link"
        text += (
            f'<joint name="{joint}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
            f'<origin xyz="{xyz}" rpy="0 0 0"/><axis xyz="{axis}"/>'
            f'<limit lower="{low}" upper="{high}" effort="1" velocity="1"/></joint>\n'
            f'<link name="{child}"/>\n'
        )
        parent = child
    return f'<robot name="{name}">\n{text}</robot>\n'
