"""The names in the drawing of an arm: joint axes by number, frames, and lengths as in the formulas."""

from __future__ import annotations

import re
from html import escape

import numpy as np

from ikgen.formulas.mathtext import GREEK
from ikgen.model.arrays import Array
from ikgen.report.camera import Camera
from ikgen.report.skeleton_bones import Bone, JointMark, Skeleton

__all__ = ["name_parts"]


AXIS, LENGTH = "#8a99a8", "#2f6f4f"
_RED, _BLUE = "#d2484a", "#3b78d8"
_LINE = 13.0
"""Height of a line of text (px)."""


def name_parts(camera: Camera, arm: Skeleton, radius: float) -> list[str]:
    """Axes, frames and names, laid over the arm; texts move apart where they would meet."""
    taken: list[Array] = [camera.place(mark.at) for mark in arm.joints]
    parts = [_axis(camera, mark, radius) for mark in arm.joints]
    parts += [_frame(camera, T, radius) for T in arm.frames[:-1]]
    for mark in arm.joints:
        along = _flat(camera, mark.along)
        start = camera.place(mark.at) + along * 3.4 * radius
        shown = f'z<tspan dy="3" font-size="8.5">{mark.number}</tspan>'
        parts.append(_text(_free(start, along, taken, camera), shown, AXIS, "arm-axisname"))
    for bone in arm.bones:
        if bone.name:
            parts.append(_length(camera, bone, taken))
    return parts


def _flat(camera: Camera, along: Array) -> Array:
    """A direction (3,) in the drawing (2,), of length 1 unless it points at the eye."""
    flat = (camera.axes[:2] @ along) * (1.0, -1.0)
    return np.asarray(flat / max(float(np.linalg.norm(flat)), 0.3))


def _axis(camera: Camera, mark: JointMark, radius: float) -> str:
    """The dashed line of a joint's axis."""
    a, b = (camera.place(mark.at) + s * _flat(camera, mark.along) * 2.8 * radius for s in (-1, 1))
    return (
        f'<path class="arm-axis" d="M{a[0]:.1f} {a[1]:.1f}L{b[0]:.1f} {b[1]:.1f}" stroke="{AXIS}" '
        'stroke-width="1" stroke-dasharray="5 2 1 2"/>'
    )


def _frame(camera: Camera, T: Array, radius: float) -> str:
    """A row's frame at its origin: x red, z blue."""
    at, out = camera.place(T[:3, 3]), []
    for column, colour in ((0, _RED), (2, _BLUE)):
        end = at + (camera.axes[:2] @ T[:3, column]) * (1.0, -1.0) * 1.7 * radius
        out.append(
            f'<path d="M{at[0]:.1f} {at[1]:.1f}L{end[0]:.1f} {end[1]:.1f}" stroke="{colour}" '
            'stroke-width="1.6" stroke-linecap="round"/>'
        )
    return "".join(out)


def _length(camera: Camera, bone: Bone, taken: list[Array]) -> str:
    a, b = camera.place(np.array([bone.start, bone.end]))
    across = np.array([b[1] - a[1], a[0] - b[0]])
    across = across / max(float(np.linalg.norm(across)), 1e-9)
    if across[0] < 0:
        across = -across  # to the right, where there is more often room than over the arm
    at = _free((a + b) / 2 + 14 * across, across, taken, camera)
    letter, _, index = bone.name.partition("_")
    sub = f'<tspan dy="3" font-size="9">{escape(index)}</tspan>' if index else ""
    shown = f'<tspan font-style="italic">{escape(GREEK.get(letter, letter))}</tspan>{sub}'
    return _text(at, shown, LENGTH, "arm-length", 13)


def _free(at: Array, along: Array, taken: list[Array], camera: Camera) -> Array:
    """The first place from `at` on, outwards along a direction, where no text is."""
    step = along / max(float(np.linalg.norm(along)), 1e-9) * 6.0
    room = np.array([camera.width, camera.height])
    for turn in range(24):
        side = step if turn % 2 == 0 else -step
        place = at + side * ((turn + 1) // 2)
        clear = all(np.hypot(*((place - p) / (1.5, 1.0))) > _LINE for p in taken)
        if clear and np.all(place > 8) and np.all(place < room - 8):
            break
    place = np.clip(place, 8, room - 8)
    taken.append(place)
    return place


def _text(at: Array, inside: str, colour: str, kind: str, size: float = 11) -> str:
    plain = re.sub(r"\s+", " ", inside)
    return (
        f'<text class="{kind}" x="{at[0]:.1f}" y="{at[1] + 4:.1f}" text-anchor="middle" '
        f'font-size="{size:g}" fill="{colour}">{plain}</text>'
    )
