"""The elbow arm with a crank beside it that drives its waist."""

from __future__ import annotations

from pathlib import Path

from tests.support.small_robots import elbow_robot

__all__ = ["crank_robot"]

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
