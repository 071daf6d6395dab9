"""From links to rows: how the screws beside each common normal add up to theta and d.

The offset along a run of parallel axes has no place of its own, since their common normal can be
anywhere. It goes where it does least harm: into the base or the tip constant where the run reaches
an end, else into a prismatic variable, else into d of the run's last axis.
"""

from __future__ import annotations

from dataclasses import dataclass

from ikgen.kinematics.links import LinkShape
from ikgen.kinematics.snapping import wrap_angle

__all__ = ["Offsets", "distribute"]


@dataclass(frozen=True, slots=True)
class Offsets:
    """Constants of n rows before the ends are chosen: `d` (m), its `length_error` (m), `theta` (rad).

    The first theta lacks the base's turn and the last one the tip's; `base_lift` and `tip_lift` (m)
    are what the end constants take along the first and the last axis.
    """

    d: tuple[float, ...]
    theta: tuple[float, ...]
    length_error: tuple[float, ...]
    base_lift: float
    tip_lift: float


def distribute(shapes: tuple[LinkShape, ...], prismatic: tuple[bool, ...]) -> Offsets:
    """Row constants of the n axes that the n - 1 `shapes` link."""
    n = len(prismatic)
    d, length_error = [0.0] * n, [0.0] * n
    base_lift = tip_lift = 0.0
    for first, last in _parallel_runs(shapes):
        total = sum(shape.s1 + shape.s2 for shape in shapes[first:last])
        total += shapes[first - 1].s2 if first > 0 else 0.0
        total += shapes[last].s1 if last < n - 1 else 0.0
        if first == 0:
            base_lift = total
        elif last == n - 1:
            tip_lift = total
        else:
            sliding = [k for k in range(first, last + 1) if prismatic[k]]
            k = sliding[0] if sliding else last
            d[k] = total
            length_error[k] = sum(shape.link.length_error for shape in shapes[first - 1 : last + 1])
    theta = tuple(wrap_angle(angle) for angle in _turns(shapes, prismatic))
    return Offsets(tuple(d), theta, tuple(length_error), base_lift, tip_lift)


def _parallel_runs(shapes: tuple[LinkShape, ...]) -> list[tuple[int, int]]:
    """First and last index of each longest run of parallel axes, runs of one axis included."""
    runs, first = [], 0
    for k, shape in enumerate(shapes):
        if not shape.parallel:
            runs.append((first, k))
            first = k + 1
    return [*runs, (first, len(shapes))]


def _turns(shapes: tuple[LinkShape, ...], prismatic: tuple[bool, ...]) -> list[float]:
    """Angle from the previous to the next normal about each axis (rad).

    Between axes on one line the normal points anywhere: it is chosen so that prismatic rows keep
    theta = 0, and otherwise so that the first of the two does.
    """
    thetas, arriving = [], 0.0
    for k, shape in enumerate(shapes):
        leaving = shape.phi
        if shape.same_line:
            beyond = shapes[k + 1] if k + 1 < len(shapes) else None
            settles_next = prismatic[k + 1] and beyond is not None and not beyond.same_line
            if settles_next and beyond is not None and not (prismatic[k] and k > 0):
                leaving = shape.psi + beyond.phi
            else:
                leaving = -arriving
        thetas.append(arriving + leaving)
        arriving = shape.psi - (leaving - shape.phi)
    return [*thetas, arriving]
