"""Controls for a path: mark poses by dragging or clicking, follow them, look at the arm along the way."""

from __future__ import annotations

from typing import Any

import numpy as np

from ikgen.model.arrays import Array
from ikgen.view.followed_path import Followed, between, followed
from ikgen.view.panel_scene import PanelScene

__all__ = ["PathPanel"]


_COLOURS = {"OK": (5, 78, 20), "LIMITS": (183, 78, 3), "UNREACHABLE": (132, 11, 11)}
_OTHER, _REACHED = (48, 11, 89), (3, 26, 147)
"""In linear light, as lines are drawn."""


class PathPanel:
    """`marks` are poses (4, 4) of the target, `followed` what came of following them (None: nothing)."""

    def __init__(self, scene: PanelScene) -> None:
        self._scene, self._server = scene, scene.server
        self.marks: list[Array] = []
        self.followed: Followed | None = None
        self._drawn: list[Any] = []
        gui = self._server.gui
        with gui.add_folder("path", expand_by_default=False):
            mark = gui.add_button("mark the target", hint="or Shift-click into the scene")
            self._dragging = gui.add_checkbox("mark while dragging", initial_value=False)
            follow = gui.add_button("follow")
            clear = gui.add_button("clear")
            self._along = gui.add_slider("along", 0.0, 1.0, 0.001, 0.0, disabled=True)
            self._words = gui.add_markdown("no poses marked")
        mark.on_click(lambda _: self.mark(scene.pose))
        follow.on_click(lambda _: self.follow())
        clear.on_click(lambda _: self.clear())
        self._along.on_update(lambda _: self._look())
        self._server.scene.on_click(modifier="shift")(self._clicked)

    def dragged(self, pose: Array) -> None:
        """The target was moved."""
        least = 0.02 * self._scene.size
        if self._dragging.value and (
            not self.marks or np.linalg.norm(pose[:3, 3] - self.marks[-1][:3, 3]) > least
        ):
            self.mark(pose)

    def mark(self, pose: Array) -> None:
        """One more pose (4, 4)."""
        self.marks.append(np.array(pose))
        self.followed = None
        self._words.content = f"poses marked: {len(self.marks)}"
        self.draw()

    def clear(self) -> None:
        """No poses."""
        self.marks, self.followed = [], None
        self._along.disabled = True
        self._words.content = "no poses marked"
        self.draw()
        self._scene.draw()

    def follow(self) -> None:
        """Follow the marked poses from the chosen solution."""
        if len(self.marks) < 2:
            self._words.content = "mark two poses or more"
            return
        scene = self._scene
        poses = between(self.marks, scene.size)
        self.followed = followed(scene.runner, poses, scene.chosen, scene.held)
        self._words.content = self.followed.words
        self._along.disabled = not len(self.followed.q)
        self.draw()

    def draw(self) -> None:
        """The marks, and the path in the colours of its status."""
        for handle in self._drawn:
            handle.remove()
        self._drawn = []
        if not self.marks:
            return
        points = np.array([T[:3, 3] for T in self.marks])
        size = 0.015 * self._scene.size
        self._drawn.append(
            self._server.scene.add_point_cloud(
                "/marks", points, (40, 40, 40), point_size=size, point_shape="circle"
            )
        )
        if self.followed is not None:
            self._drawn.append(self._line("/path", self.followed))

    def _line(self, name: str, path: Followed) -> Any:
        """Segments from pose to pose."""
        at = path.poses[:, :3, 3]
        ends = np.stack([at[:-1], at[1:]], axis=1).astype(np.float32)
        reached = len(path.q)
        colours = [
            _REACHED if i < reached else _COLOURS.get(path.alone[i], _OTHER)
            for i in range(1, len(at))
        ]
        wide = np.repeat(np.array(colours, dtype=np.uint8)[:, None], 2, axis=1)
        thickness = 0.012 * self._scene.size
        return self._server.scene.add_line_segments(name, ends, wide, thickness=thickness)

    def _look(self) -> None:
        """The arm where the slider says."""
        if self.followed is not None and len(self.followed.q):
            last = len(self.followed.q) - 1
            self._scene.show(self.followed.q[round(self._along.value * last)])

    def _clicked(self, event: Any) -> None:
        """A point of the plane through the target that faces the viewer, with the target's rotation."""
        target = self._scene.pose
        camera = event.client.camera
        normal = np.asarray(camera.look_at, dtype=float) - np.asarray(camera.position, dtype=float)
        origin = np.asarray(event.ray_origin, dtype=float)
        along = np.asarray(event.ray_direction, dtype=float)
        slope = float(along @ normal)
        if slope > 1e-9:
            target[:3, 3] = origin + along * float((target[:3, 3] - origin) @ normal) / slope
            self.mark(target)
