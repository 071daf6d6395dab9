"""Serial arms as URDF files, from where each joint lies in the one before."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

__all__ = ["Origin", "serial_urdf"]

Origin = tuple[str, str]
"""xyz (m) and rpy (rad), as files have them."""


def serial_urdf(
    path: Path,
    origins: Sequence[Origin],
    *,
    tip: Origin | None = None,
    axes: Sequence[str] | None = None,
    slides: Mapping[int, str] | None = None,
    limit: float | Sequence[tuple[float, float]] | None = None,
) -> Path:
    """Joints j0, j1, ... between links l0, l1, ..., which turn about z or each about its one of `axes`,
    without limits, to `limit` (rad, m) to either side or each in its range; those without an axis ("") are
    fixed, those of `slides` slide along their axes. With `tip` a fixed link of that name."""
    along = slides or {}
    about = axes or ["0 0 1"] * len(origins)
    ranges = [(-limit, limit)] * len(origins) if isinstance(limit, float) else limit
    bound, text = "", '<link name="l0"/>'
    for k, ((xyz, rpy), axis) in enumerate(zip(origins, about, strict=True)):
        kind = "prismatic" if k in along else "continuous" if limit is None else "revolute"
        kind = kind if k in along or axis else "fixed"
        if ranges is not None:
            low, high = ranges[k]
            bound = f'<limit lower="{low}" upper="{high}" effort="1" velocity="1"/>'
        text += (
            f'<joint name="j{k}" type="{kind}"><parent link="l{k}"/><child link="l{k + 1}"/>'
            f'<origin xyz="{xyz}" rpy="{rpy}"/>'
            + (f'<axis xyz="{along.get(k, axis)}"/>{bound}' if kind != "fixed" else "")
            + f'</joint><link name="l{k + 1}"/>'
        )
    if tip is not None:
        text += (
            f'<joint name="tool" type="fixed"><parent link="l{len(origins)}"/><child link="tip"/>'
            f'<origin xyz="{tip[0]}" rpy="{tip[1]}"/></joint><link name="tip"/>'
        )
    path.write_text(f'<robot name="{path.stem}">{text}</robot>')
    return path
