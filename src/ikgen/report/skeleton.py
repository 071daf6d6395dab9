"""An arm drawn as a skeleton: links, joints, frames and the names of its lengths, as one SVG.

Colours are attributes of the elements, so that a drawing stands alone; a page changes them by the
classes `arm-link`, `arm-joint`, `arm-top`, `arm-shade`, `arm-shadow`, `arm-axis`, `arm-axisname`,
`arm-length`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

import numpy as np
from numpy.typing import ArrayLike

from ikgen.model.arrays import Array
from ikgen.model.dh import DHChain
from ikgen.report.camera import Camera, hull, look_at
from ikgen.report.skeleton_bones import Bone, JointMark, Skeleton, skeleton
from ikgen.report.skeleton_names import name_parts

__all__ = ["Style", "skeleton_camera", "skeleton_svg"]

Layer = tuple[float, str]
"""A part of the drawing and how near to the eye it is."""

LINK, JOINT, TOP, SHADE = "#48607a", "#e8973a", "#f6c98b", "#8a99a8"
_RED, _BLUE = "#d2484a", "#3b78d8"
_CORNERS = 20


@dataclass(frozen=True, slots=True)
class Style:
    """How large a drawing is (px), and whether it names what it shows: axes, frames and lengths."""

    width: float = 560.0
    height: float = 430.0
    named: bool = True

    @property
    def margin(self) -> float:
        """Free room at the edges."""
        return 34.0 if self.named else 16.0

    @property
    def radius(self) -> float:
        """Radius of a joint."""
        return min(self.width, self.height) * (0.024 if self.named else 0.045)


def skeleton_camera(dh: DHChain, rows: Sequence[ArrayLike], style: Style) -> Camera:
    """One camera for several configurations (dof,), so that their drawings can be compared."""
    arms = [skeleton(dh, q) for q in rows]
    parts = [arm.points for arm in arms] + [_floor(arm) for arm in arms if _stands(arm)]
    return look_at(np.concatenate(parts), style.width, style.height, style.margin)


def skeleton_svg(
    dh: DHChain,
    q: ArrayLike,
    *,
    style: Style | None = None,
    camera: Camera | None = None,
    title: str = "",
) -> str:
    """The SVG of an arm at joint values `q` (dof,), rad and m, in the base link's frame (z upwards)."""
    style = style or Style()
    arm = skeleton(dh, q)
    camera = camera or skeleton_camera(dh, [q], style)
    layers = [_bone(camera, bone, style) for bone in arm.bones]
    layers += [_joint(camera, mark, style) for mark in arm.joints]
    parts = [_shade(camera, arm, style), *(text for _, text in sorted(layers, key=lambda p: p[0]))]
    parts += [_tool(camera, arm, style)]
    if style.named:
        parts += name_parts(camera, arm, style.radius)
    words = escape(title or f"{dh.robot} as a skeleton")
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" class="arm" viewBox="0 0 {style.width:g} '
        f'{style.height:g}" width="{style.width:g}" height="{style.height:g}" role="img" '
        f'font-family="sans-serif"><title>{words}</title>\n' + "\n".join(parts) + "\n</svg>\n"
    )


def _path(points: Array, *, closed: bool = False) -> str:
    """The `d` of a path through places (n, 2)."""
    return "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in points + 0.0) + "Z" * closed


def _stands(arm: Skeleton) -> bool:
    """Whether the arm is above its base, as one on the floor is."""
    return bool(arm.points[:, 2].mean() > 0.0)


def _floor(arm: Skeleton) -> Array:
    """The shadow's corners (n, 3)."""
    return np.asarray(np.concatenate([arm.points[:1], arm.points[1::2]]) * (1.0, 1.0, 0.0))


def _shade(camera: Camera, arm: Skeleton, style: Style) -> str:
    """The base's disc on the floor, and the shadow that the arm casts there."""
    angles = np.linspace(0.0, 2 * np.pi, 33)[:-1]
    wide = 2.4 * style.radius / camera.scale
    rim = wide * np.stack([np.cos(angles), np.sin(angles), np.zeros(32)], axis=1)
    disc = (
        f'<path class="arm-shade" d="{_path(camera.place(rim), closed=True)}" fill="{SHADE}" '
        'fill-opacity="0.3"/>'
    )
    if not _stands(arm):
        return disc
    return disc + (
        f'<path class="arm-shadow" d="{_path(camera.place(_floor(arm)))}" fill="none" '
        f'stroke="{SHADE}" stroke-opacity="0.35" stroke-width="{style.radius / 2:.1f}" '
        'stroke-linejoin="round" stroke-linecap="round"/>'
    )


def _bone(camera: Camera, bone: Bone, style: Style) -> Layer:
    """A link; a sliding one as a thin rod in a wide one."""
    path = _path(camera.place(np.array([bone.start, bone.end])))
    wide = style.radius * (0.55 if bone.slides else 0.75)
    dash = ' stroke-dasharray="7 3"' if bone.slides else ' stroke-linecap="round"'
    text = (
        f'<path class="arm-link" d="{path}" fill="none" stroke="{LINK}" '
        f'stroke-width="{wide:.1f}"{dash}/>'
    )
    return camera.depth((bone.start + bone.end) / 2), text


def _joint(camera: Camera, mark: JointMark, style: Style) -> Layer:
    """A short cylinder about the axis of a revolute joint, a box along that of a sliding one."""
    size = style.radius / camera.scale
    side = np.cross(mark.along, (0.0, 0.0, 1.0) if abs(mark.along[2]) < 0.9 else (1.0, 0.0, 0.0))
    side /= np.linalg.norm(side)
    other = np.cross(mark.along, side)
    corners = _CORNERS if mark.revolute else 4
    angles = np.linspace(0.0, 2 * np.pi, corners + 1)[:-1, None] + np.pi / 4
    rim = size * (np.cos(angles) * side + np.sin(angles) * other)
    half = (1.1 if mark.revolute else 1.6) * size * mark.along
    near = half if camera.depth(half) >= 0 else -half
    body = hull(
        np.concatenate([camera.place(mark.at + rim + half), camera.place(mark.at + rim - half)])
    )
    face = camera.place(mark.at + rim + near)
    edge = f'stroke="{LINK}" stroke-width="0.8" stroke-linejoin="round"'
    text = (
        f'<path class="arm-joint" d="{_path(body, closed=True)}" fill="{JOINT}" {edge}/>'
        f'<path class="arm-top" d="{_path(face, closed=True)}" fill="{TOP}" {edge}/>'
    )
    return camera.depth(mark.at + 0.5 * near), text


def _tool(camera: Camera, arm: Skeleton, style: Style) -> str:
    """The tip's frame: its z axis blue, its x axis red."""
    T, length = arm.frames[-1], 2.6 * style.radius / camera.scale
    out = []
    for column, colour in ((0, _RED), (2, _BLUE)):
        line = camera.place(np.array([T[:3, 3], T[:3, 3] + length * T[:3, column]]))
        out.append(
            f'<path d="{_path(line)}" stroke="{colour}" stroke-width="{style.radius / 3.5:.1f}" '
            'stroke-linecap="round"/>'
        )
    return "".join(out)
