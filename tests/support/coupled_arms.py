"""The elbow arm with a crank beside it that drives its waist, and tables whose joints are coupled."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

from tests.support.small_robots import elbow_robot

__all__ = ["coupled_table", "crank_robot", "hollow_wrist", "parallelogram_arm"]

_CRANK = (
    '<joint name="crank" type="{kind}"><parent link="base_link"/><child link="wheel"/><axis xyz="0 0 1"/>'
    '<limit lower="{low}" upper="{high}" effort="1" velocity="1"/></joint><link name="wheel"/>\n'
)


def crank_robot(
    folder: Path,
    ratio: float,
    limits: tuple[float, float],
    *,
    followers: tuple[str, ...] = ("waist",),
    kind: str = "revolute",
) -> Path:
    """URDF of the elbow arm whose `followers` turn `ratio` times as far as `crank`, a joint of this kind
    with these limits (rad or m) outside the chain."""
    text = elbow_robot("cranked")
    for name in followers:
        head, rest = text.split(f'<joint name="{name}" type="revolute">')
        mimic = f'<mimic joint="crank" multiplier="{ratio!r}"/>'
        text = f'{head}<joint name="{name}" type="revolute">{mimic}{rest}'
    crank = _CRANK.format(kind=kind, low=limits[0], high=limits[1])
    path = folder / "cranked.urdf"
    path.write_text(text.replace("</robot>", f"{crank}</robot>"))
    return path


def coupled_table(
    folder: Path, alpha: Sequence[float], a: Sequence[float], d: Sequence[float]
) -> Path:
    """A DH table (modified) of revolute joints q1, q2, ... with these twists (rad) and lengths (m)."""
    lines = ['name = "coupled"', 'convention = "modified"']
    for k, (twist, length, offset) in enumerate(zip(alpha, a, d, strict=True), start=1):
        lines += ["[[joints]]", f'name = "q{k}"', 'type = "revolute"', f"alpha = {twist!r}"]
        lines += [f"a = {length!r}", f"d = {offset!r}", "theta = 0"]
    path = folder / "coupled.toml"
    path.write_text("\n".join(lines) + "\n")
    return path


def hollow_wrist(folder: Path) -> Path:
    """An elbow arm with a hollow wrist: axes 4 to 7 at 35, 70 and 35 degrees, of which joint 6 is to turn
    back what joint 5 turns."""
    tilt = math.radians(35.0)
    alpha = [0.0, math.pi / 2, 0.0, math.pi / 2, tilt, -2.0 * tilt, tilt]
    return coupled_table(
        folder, alpha, [0.0, 0.3, 1.2, 0.2, 0, 0, 0], [0, 0, 0, 1.4, 0.08, 0.08, 0]
    )


def parallelogram_arm(folder: Path) -> Path:
    """An arm whose forearm a parallelogram keeps from turning with the upper arm: joint 4 is to turn back
    what joint 2 turns, on the axis of joint 3. Its wrist's axes are offset and at 70 degrees."""
    tilt = math.radians(70.0)
    alpha = [0.0, -math.pi / 2, 0.0, 0.0, -math.pi / 2, tilt, -tilt]
    return coupled_table(
        folder, alpha, [0.0, 0.0, 1.4, 0.0, 0, 0, 0], [0, 0.378, 0, 0, 1.35, 0.105, 0.1125]
    )
