"""The scene in the browser: a target that can be dragged, the solutions as skeletons, sliders for held
joints, a table of numbers. What is drawn follows the target."""

from __future__ import annotations

import threading
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ikgen.emit.derivation import Derivation
from ikgen.errors import MissingToolError
from ikgen.kinematics.quaternion_rotation import quaternion, rotation
from ikgen.report.skeleton_bones import skeleton
from ikgen.report.worked_example import worked_example
from ikgen.verify.runners.python_module import PythonModule
from ikgen.view.branches import Solved, solved

__all__ = ["ArmScene", "open_server"]

Array = NDArray[np.float64]

_CHOSEN, _GHOST, _OUTSIDE = (205, 110, 20), (80, 115, 155), (190, 60, 60)


def open_server(port: int) -> Any:
    """A viser server on this machine alone; raises `MissingToolError` where viser is not installed."""
    try:
        import viser
    except ImportError as error:
        hint = "pip install 'ikgen[view]'"
        raise MissingToolError("ikgen view needs the package viser", hint=hint) from error
    return viser.ViserServer(host="127.0.0.1", port=port, verbose=False)


class ArmScene:
    """`server` is viser's; `answer` what is shown now. Moving the target, by hand or by `move`, solves
    its pose and draws all solutions."""

    def __init__(self, server: Any, derivation: Derivation, runner: PythonModule) -> None:
        self.server, self.derivation, self.runner = server, derivation, runner
        self.answer = Solved("UNREACHABLE", ())
        self._ghosts: list[Any] = []
        self._drawing = threading.Lock()
        start = worked_example(derivation, runner)
        self._size = skeleton(derivation.reading.dh, start.q).size
        server.scene.set_up_direction("+z")
        middle = np.array([*start.pose[:2, 3] / 2, 0.4 * self._size])
        server.initial_camera.look_at = tuple(middle)
        server.initial_camera.position = tuple(middle + self._size * np.array([1.5, -1.5, 0.8]))
        server.scene.add_grid("/floor", width=3 * self._size, height=3 * self._size)
        self._panel(start.q)
        self._target = server.scene.add_transform_controls(
            "/target",
            scale=0.25 * self._size,
            position=tuple(start.pose[:3, 3]),
            wxyz=tuple(quaternion(start.pose[:3, :3])),
        )
        self._target.on_update(lambda _: self.draw())
        self.draw()

    def _panel(self, q: Array) -> None:
        """The sliders of held joints, the choice of a branch, and the table."""
        gui, dh = self.server.gui, self.derivation.reading.dh
        gui.add_markdown(f"### {dh.robot}\n{dh.base_link} to {dh.tip_link}; drag the target")
        self._held = []
        for j in self.derivation.module.free:
            low, high = (max(-6.3, dh.joints[j].limits.lower), min(6.3, dh.joints[j].limits.upper))
            slider = gui.add_slider(
                dh.joints[j].name, low, high, 0.01, float(np.clip(q[j], low, high))
            )
            slider.on_update(lambda _: self.draw())
            self._held.append(slider)
        self._chosen = gui.add_slider("solution", 1, self.derivation.module.max_solutions, 1, 1)
        self._chosen.on_update(lambda _: self.draw())
        self._table = gui.add_markdown("")

    @property
    def pose(self) -> Array:
        """The target (4, 4) in the base link."""
        T = np.eye(4)
        T[:3, :3] = rotation(np.asarray(self._target.wxyz, dtype=float))
        T[:3, 3] = self._target.position
        return T

    @property
    def ghosts(self) -> int:
        """How many skeletons are drawn."""
        return len(self._ghosts)

    def move(self, pose: Array) -> None:
        """Put the target to a pose (4, 4)."""
        self._target.position = tuple(pose[:3, 3])
        self._target.wxyz = tuple(quaternion(pose[:3, :3]))
        self.draw()

    def draw(self) -> None:
        """Solve the target's pose and show what there is."""
        with self._drawing, self.server.atomic():  # several pages may drag it at once
            held = np.array([slider.value for slider in self._held]) if self._held else None
            self.answer = solved(self.derivation, self.runner, self.pose, held)
            for handle in self._ghosts:
                handle.remove()
            self._ghosts = [
                self._skeleton(i, branch.q, branch.inside)
                for i, branch in enumerate(self.answer.branches)
            ]
            self._table.content = self.answer.table(self.derivation)

    def _skeleton(self, i: int, q: Array, inside: bool) -> Any:
        """One solution: the chosen one thick, others thin, those outside the limits red."""
        bones = skeleton(self.derivation.reading.dh, q).bones
        points = np.array([[bone.start, bone.end] for bone in bones], dtype=np.float32)
        chosen = i + 1 == self._chosen.value
        colour = _CHOSEN if chosen else _GHOST if inside else _OUTSIDE
        return self.server.scene.add_line_segments(
            f"/solution {i + 1}",
            points,
            np.broadcast_to(np.array(colour, dtype=np.uint8), points.shape),
            thickness=self._size * (0.02 if chosen else 0.007),
        )
