"""A reachability map as points in the scene, each in the colour of the share of directions reached."""

from __future__ import annotations

from typing import Any

import numpy as np

from ikgen.reach.grid import grid_over
from ikgen.reach.png_image import colours
from ikgen.reach.reach_map import ReachMap, interpreted_engine, reach_map
from ikgen.view.panel_scene import PanelScene

__all__ = ["ReachPanel"]

_CELLS, _DIRECTIONS = 16, 12
"""Size of the map that is computed where none is given: it takes about a second."""


class ReachPanel:
    """`found` is the map that is shown: the given one, or a coarse one computed when it is asked for."""

    def __init__(self, scene: PanelScene, found: ReachMap | None = None) -> None:
        self._scene, self.found = scene, found
        self._handle: Any = None
        gui = scene.server.gui
        low, high = _range(found, scene.size)
        with gui.add_folder("reach", expand_by_default=found is not None):
            self._shown = gui.add_checkbox("reached positions", initial_value=found is not None)
            self._cut = gui.add_slider("from y (m)", low, high, 0.01, low)
            self._words = gui.add_markdown("")
        for control in (self._shown, self._cut):
            control.on_update(lambda _: self.draw())
        self.draw()

    @property
    def points(self) -> int:
        """How many positions are drawn."""
        return 0 if self._handle is None else len(self._handle.points)

    def show(self, from_y: float) -> None:
        """The map, cut there (m)."""
        self._cut.value = from_y
        self._shown.value = True

    def draw(self) -> None:
        """The points behind the cut that are reached in some direction."""
        if self._handle is not None:
            self._handle.remove()
            self._handle = None
        if not self._shown.value:
            return
        self.found = self.found or self._coarse()
        share = self.found.by_position.ravel()
        at = self.found.grid.positions
        kept = (share > 0) & (at[:, 1] >= self._cut.value - 1e-9)
        self._handle = self._scene.server.scene.add_point_cloud(
            "/reach",
            at[kept].astype(np.float32),
            colours(share[kept]),
            point_size=0.25 * (self.found.grid.step or 0.02),
            point_shape="circle",
            precision="float32",
        )
        self._words.content = (
            f"{kept.sum()} positions; dark: few directions have a solution inside the limits, "
            "bright: all of them"
        )

    def _coarse(self) -> ReachMap:
        """By the emitted Python module, in this process."""
        derivation = self._scene.derivation
        grid = grid_over(derivation.reading.dh, _CELLS, _DIRECTIONS, 1)
        engine = interpreted_engine(derivation)
        return reach_map(derivation, grid, engine, engine.size, None)


def _range(found: ReachMap | None, size: float) -> tuple[float, float]:
    """From where to where (m) the cut can be moved."""
    if found is None:
        return -round(1.5 * size, 2), round(1.5 * size, 2)
    low, high = float(found.grid.y[0]), float(found.grid.y[-1])
    return float(np.floor(100 * low) / 100), float(np.ceil(100 * high) / 100) + 0.01
