"""An arm that lifts, extends a telescope of equal stages, and turns a wrist of two joints."""

from __future__ import annotations

from pathlib import Path

__all__ = ["RELATIONS", "STAGES", "telescope_robot"]

STAGES = ("stage_1", "stage_2", "stage_3", "stage_4")
RELATIONS = {
    "stage_2": "stage_1*1+0.01",
    "stage_3": "stage_1*1+0.02",
    "stage_4": "stage_1*0.5+0.03",
}
"""What the other stages are to do, so that the first moves 3.5 times as far in all."""
_SQUARE = "1.5707963267948966 0 0"


def telescope_robot(folder: Path, travels: tuple[float, ...] = (0.13,) * 4) -> Path:
    """URDF of the arm, stages of these travels (m) that begin at 0, 0.01, ..."""
    rows = [("lift", "prismatic", "0 0 0.2", "0 0 0", 0.0, 1.1)]
    for i, travel in enumerate(travels):
        turn = _SQUARE if i == 0 else "0 0 0"
        rows.append((STAGES[i], "prismatic", "0 0 0.05", turn, 0.01 * i, 0.01 * i + travel))
    rows.append(("yaw", "revolute", "0.08 0 0", "-1.5707963267948966 0 0", -1.7, 2.0))
    rows.append(("pitch", "revolute", "0 0.03 0.02", _SQUARE, -1.5, 0.5))
    text = '<link name="base"/>\n'
    for n, (name, kind, xyz, rpy, low, high) in enumerate(rows, start=1):
        parent = "base" if n == 1 else f"link_{n - 1}"
        text += (
            f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="link_{n}"/>'
            f'<origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="0 0 1"/>'
            f'<limit lower="{low!r}" upper="{high!r}" effort="1" velocity="1"/></joint>\n'
            f'<link name="link_{n}"/>\n'
        )
    path = folder / "telescope.urdf"
    path.write_text(f'<robot name="telescope">\n{text}</robot>\n')
    return path
