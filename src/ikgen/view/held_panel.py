"""Sliders of what is held, and the sweep of one over its range."""

from __future__ import annotations

import threading
import time
from typing import TYPE_CHECKING, Any

import numpy as np

from ikgen.lowering.held_angle import held_values
from ikgen.model.arrays import Array
from ikgen.view.panel_scene import PanelScene

if TYPE_CHECKING:
    from ikgen.report.worked_example import WorkedExample

__all__ = ["HeldPanel"]


_WIDEST = 6.3
_STEPS, _SECONDS = 120, 6.0
"""Values of one sweep there and back, and how long it takes."""


class HeldPanel:
    """`values` are those of what is held (rad or m), joints or the arm angle, at first `start`'s; None
    for an arm that holds nothing."""

    def __init__(self, scene: PanelScene, start: WorkedExample) -> None:
        self._scene = scene
        dh, gui = scene.derivation.reading.dh, scene.server.gui
        values = held_values(dh, start.q, start.pose)
        self._sliders: list[Any] = []
        self._stop = threading.Event()
        self._sweeping = threading.Lock()
        for held, value in zip(dh.held_inputs, () if values is None else values, strict=True):
            low, high = max(-_WIDEST, held.limits.lower), min(_WIDEST, held.limits.upper)
            first = float(np.clip(value, low, high))
            slider = gui.add_slider(held.name, low, high, 0.01, first)
            slider.on_update(lambda _: scene.draw())
            self._sliders.append(slider)
        for slider in self._sliders:
            button = gui.add_button(f"sweep {slider.label}", hint="once more ends it")
            button.on_click(lambda _, slider=slider: self._toggle(slider))
        self._words = gui.add_markdown("") if self._sliders else None
        self._described: Array | None = None

    @property
    def values(self) -> Array | None:
        """The values of all sliders."""
        return np.array([slider.value for slider in self._sliders]) if self._sliders else None

    def describe(self, pose: Array) -> None:
        """For which values of the one thing held the pose (4, 4) has solutions."""
        if self._words is None or len(self._sliders) != 1:
            return
        if self._described is not None and np.array_equal(pose, self._described):
            return
        self._described = pose
        found = self._scene.runner.module.self_motion(pose)
        parts = [f"{low:.2f} to {high:.2f}" for low, high in _union(found)]
        where = ", ".join(parts) if parts else "no value"
        self._words.content = f"solutions for {self._sliders[0].label} at {where}"

    @property
    def words(self) -> str:
        """Where the one held joint has solutions."""
        return "" if self._words is None else str(self._words.content)

    def sweep(self, slider: Any, seconds: float = _SECONDS) -> int:
        """Take a joint over its range, from where it is to the upper end, to the lower and back, in
        `seconds` at least; how many values were drawn until the end or `stop`."""
        self._stop.clear()
        start, drawn = float(slider.value), 0
        way = 2.0 * (slider.max - slider.min)
        for k in range(1, _STEPS + 1):
            began = time.monotonic()
            slider.value = _there_and_back(start - slider.min + way * k / _STEPS, way) + slider.min
            drawn += 1
            if self._stop.wait(max(0.0, seconds / _STEPS - (time.monotonic() - began))):
                break
        return drawn

    def stop(self) -> None:
        """End a sweep."""
        self._stop.set()

    def _toggle(self, slider: Any) -> None:
        """Sweep, or end the sweep that goes on."""
        if not self._sweeping.acquire(blocking=False):
            self.stop()
            return
        try:
            self.sweep(slider)
        finally:
            self._sweeping.release()


def _union(intervals: Any) -> list[tuple[float, float]]:
    """What intervals (with `low` and `high`) cover together, from below."""
    found: list[tuple[float, float]] = []
    for low, high in sorted((one.low, one.high) for one in intervals):
        if found and low <= found[-1][1]:
            found[-1] = (found[-1][0], max(high, found[-1][1]))
        else:
            found.append((low, high))
    return found


def _there_and_back(x: float, way: float) -> float:
    """A triangle wave of that period."""
    x %= way
    return min(x, way - x)
