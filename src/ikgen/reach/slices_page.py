"""A map as a page: slices of its grid as images, what they show in numbers; one file, nothing to fetch."""

from __future__ import annotations

from html import escape

import numpy as np
from numpy.typing import NDArray

from ikgen.emit.rendering import render
from ikgen.model.arrays import Array
from ikgen.reach.grid import Grid
from ikgen.reach.png_image import COLOURS, data_address, png
from ikgen.reach.reach_map import ReachMap

__all__ = ["slices_page"]

Marks = list[tuple[float, str]]
"""Numbers beside a bar of colours: where, percent of its length, and the text."""

_PIXELS, _MOST = 300, 12
_PARTS = (4, 5, 3, 2, 1)
"""Into how many a bar is divided, the first that suits."""


def slices_page(found: ReachMap, command: str) -> str:
    """The text of the .html file; `command` makes it again."""
    best, most = found.sigma.max(axis=3).astype(float), found.count.max(axis=3).astype(float)
    room = found.margin.max(axis=3).astype(float)
    whole, of_best = _marks(float(most.max()), whole=True), _marks(float(best.max()))
    layers = [
        ("share of directions that have a solution", found.by_position, _marks(100.0, " %")),
        ("solutions a pose, the most of any direction", _scaled(most), whole),
        ("smallest singular value, the best direction", _scaled(best), of_best),
        ("room to the joint limits, the best direction", room, _marks(1.0)),
    ]
    stops = [f"rgb({r},{g},{b})" for r, g, b in COLOURS.tolist()]
    return render(
        "reach",
        "slices.html.jinja",
        title=escape(f"Reach of {found.robot}"),
        facts=[(escape(name), escape(text)) for name, text in _facts(found, command)],
        colours=", ".join(stops),
        sections=[(escape(n), marks, _slices(found, values)) for n, values, marks in layers],
    )


def _marks(most: float, unit: str = "", *, whole: bool = False) -> Marks:
    """From 0 to `most` in equal parts, or in `whole` ones."""
    parts = next(n for n in _PARTS if not (whole and most % n)) if most else 0
    share = [i / parts for i in range(1, parts + 1)]
    return [(0.0, f"0{unit}"), *((100 * s, f"{s * most:.3g}{unit}") for s in share)]


def _scaled(values: NDArray[np.generic]) -> Array:
    """Relative to the largest."""
    numbers = values.astype(float)
    return numbers / max(float(numbers.max()), 1e-12)


def _facts(found: ReachMap, command: str) -> list[tuple[str, str]]:
    nx, ny, nz, n = found.grid.shape
    step = 1e3 * found.grid.step
    return [
        ("chain", f"{found.base} to {found.tip}, task {found.task}"),
        ("grid", f"{nx} by {ny} by {nz} positions, {step:.3g} mm apart; {n} orientations each"),
        ("extent", _extent(found.grid)),
        ("pictures", "x to the right; y upwards, from the side z"),
        ("poses", f"{found.grid.poses:,}, {100 * found.solved:.1f} % with a solution inside the limits"),
        ("positions", f"{100 * (found.by_position > 0).mean():.1f} % reached in some direction, "
         f"{100 * (found.by_position == 1).mean():.1f} % in all of them"),
        ("solutions", f"at most {int(found.count.max())} a pose, {found.count.mean():.2f} on average"),
        ("best singular value", f"{float(found.sigma.max()):.3g}, lengths relative to {found.size:.3g} m"),
        ("make it again", command),
    ]  # fmt: skip


def _extent(grid: Grid) -> str:
    """From the outermost positions to each other."""
    axes = (("x", grid.x), ("y", grid.y), ("z", grid.z))
    return "; ".join(f"{name} from {_metres(x[0])} to {_metres(x[-1])} m" for name, x in axes)


def _metres(length: float) -> str:
    return f"{round(length, 9) + 0.0:.3g}"


def _slices(found: ReachMap, values: Array) -> list[tuple[str, str]]:
    """One upright slice through the base's axis, and level ones from below to above."""
    grid = found.grid
    middle = int(np.argmin(np.abs(grid.y)))
    aside = f"y = {_metres(grid.y[middle])} m, seen from the side"
    out = [(aside, _image(values[:, middle, :].T[::-1]))]
    wanted = np.unique(np.linspace(0, len(grid.z) - 1, min(_MOST, len(grid.z))).round().astype(int))
    for k in wanted.tolist():
        if values[:, :, k].any():
            words = f"z = {_metres(grid.z[k])} m, seen from above"
            out.append((words, _image(values[:, :, k].T[::-1])))
    return out


def _image(values: Array) -> str:
    return data_address(png(values, max(1, _PIXELS // max(values.shape))))
