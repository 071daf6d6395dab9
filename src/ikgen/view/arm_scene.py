"""The scene in the browser: a target that can be dragged, the solutions as skeletons, the chosen one with
its meshes, and the panels beside them. What is drawn follows the target."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ikgen.emit.derivation import Derivation
from ikgen.errors import MissingToolError
from ikgen.kinematics.quaternion_rotation import quaternion, rotation
from ikgen.model.arrays import Array
from ikgen.reach.reach_map import ReachMap
from ikgen.report.skeleton_bones import skeleton
from ikgen.report.worked_example import worked_example
from ikgen.verify.runners.python_module import PythonModule
from ikgen.view.branches import Solved, solved
from ikgen.view.held_panel import HeldPanel
from ikgen.view.path_panel import PathPanel
from ikgen.view.reach_panel import ReachPanel
from ikgen.view.robot_meshes import robot_meshes

__all__ = ["ArmScene", "open_server", "require_viser"]


_CHOSEN, _GHOST, _OUTSIDE = (154, 40, 2), (21, 44, 84), (132, 11, 11)
_LAST = (79, 79, 79)
"""In linear light, as lines are drawn."""


def require_viser() -> Any:
    """The package viser; raises `MissingToolError` where it is not installed."""
    try:
        import viser
    except ImportError as error:
        hint = "pip install 'ikgen[view]'"
        raise MissingToolError("ikgen view needs the package viser", hint=hint) from error
    return viser


def open_server(port: int) -> Any:
    """A viser server on this machine alone; raises `MissingToolError` where viser is not installed."""
    return require_viser().ViserServer(host="127.0.0.1", port=port, verbose=False)


class ArmScene:
    """`server` is viser's; `answer` what is shown now, `size` (m) the arm's. Moving the target, by hand or
    by `move`, solves its pose and draws all solutions. `package_paths` are where meshes are looked for
    too, `reach` is a map to show."""

    def __init__(
        self,
        server: Any,
        derivation: Derivation,
        runner: PythonModule,
        package_paths: Sequence[Path] = (),
        reach: ReachMap | None = None,
    ) -> None:
        self.server, self.derivation, self.runner = server, derivation, runner
        self.answer = Solved("UNREACHABLE", ())
        self._ghosts: list[Any] = []
        self._shown: Any = None
        self._drawing = threading.RLock()
        start = worked_example(derivation, runner)
        self.size = skeleton(derivation.reading.dh, start.q).size
        self._last = start.q
        self._look(start.pose)
        self.meshes = robot_meshes(server, derivation.reading, package_paths)
        dh = derivation.reading.dh
        server.gui.add_markdown(f"### {dh.robot}\n{dh.base_link} to {dh.tip_link}; drag the target")
        self.held_panel = HeldPanel(self, start)
        self._chosen = server.gui.add_slider("solution", 1, derivation.module.max_solutions, 1, 1)
        self._chosen.on_update(lambda _: self.draw())
        if self.meshes is not None:
            box = server.gui.add_checkbox("meshes", initial_value=True)
            box.on_update(lambda _: self._show_meshes(box.value))
        self._table = server.gui.add_markdown("")
        self._target = server.scene.add_transform_controls(
            "/target",
            scale=0.25 * self.size,
            position=tuple(start.pose[:3, 3]),
            wxyz=tuple(quaternion(start.pose[:3, :3])),
        )
        self.path_panel = PathPanel(self)
        self.reach_panel = ReachPanel(self, reach)
        self._target.on_update(lambda _: self._dragged())
        self.draw()

    def _look(self, pose: Array) -> None:
        """Where the viewer stands, and a floor."""
        server = self.server
        server.scene.set_up_direction("+z")
        middle = np.array([*pose[:2, 3] / 2, 0.4 * self.size])
        server.initial_camera.look_at = tuple(middle)
        server.initial_camera.position = tuple(middle + self.size * np.array([1.2, -1.2, 0.6]))
        server.scene.add_grid("/floor", width=3 * self.size, height=3 * self.size)

    @property
    def pose(self) -> Array:
        """The target (4, 4) in the base link."""
        T = np.eye(4)
        T[:3, :3] = rotation(np.asarray(self._target.wxyz, dtype=float))
        T[:3, 3] = self._target.position
        return T

    @property
    def held(self) -> Array | None:
        """Values of what is held; None for an arm that holds nothing."""
        return self.held_panel.values

    @property
    def chosen(self) -> Array:
        """Joint values (dof,) of the chosen solution; the last that there was where there is none."""
        return self._last

    @property
    def ghosts(self) -> int:
        """How many solutions are drawn."""
        return len(self._ghosts)

    def move(self, pose: Array) -> None:
        """Put the target to a pose (4, 4)."""
        self._target.position = tuple(pose[:3, 3])
        self._target.wxyz = tuple(quaternion(pose[:3, :3]))
        self.draw()

    def choose(self, number: int) -> None:
        """Choose a solution, from 1."""
        self._chosen.value = number

    def _dragged(self) -> None:
        self.path_panel.dragged(self.pose)
        self.draw()

    def draw(self) -> None:
        """Solve the target's pose and show what there is."""
        with self._drawing, self.server.atomic():  # several pages may drag it at once
            self.answer = solved(self.derivation, self.runner, self.pose, self.held)
            self._forget()
            branches = self.answer.branches
            picked = min(int(self._chosen.value), len(branches)) - 1
            for i, branch in enumerate(branches):
                colour = _CHOSEN if i == picked else _GHOST if branch.inside else _OUTSIDE
                thick = 0.02 if i == picked else 0.007
                name = f"/solution {i + 1}"
                self._ghosts.append(self._skeleton(name, branch.q, colour, thick))
            if branches:
                self._last = branches[picked].q
            else:
                self._shown = self._skeleton("/shown", self._last, _LAST, 0.004)
            if self.meshes is not None:
                self.meshes.show(self._last)
            self._table.content = self.answer.table(self.derivation)
            self.held_panel.describe(self.pose)

    def show(self, q: Array) -> None:
        """One configuration (dof,) in place of the solutions, until the target moves."""
        with self._drawing, self.server.atomic():
            self._forget()
            self._last = q
            self._shown = self._skeleton("/shown", q, _CHOSEN, 0.02)
            if self.meshes is not None:
                self.meshes.show(q)

    def _forget(self) -> None:
        for handle in [*self._ghosts, *([self._shown] if self._shown else [])]:
            handle.remove()
        self._ghosts, self._shown = [], None

    def _show_meshes(self, shown: bool) -> None:
        if self.meshes is not None:
            self.meshes.visible = shown

    def _skeleton(self, name: str, q: Array, colour: tuple[int, int, int], thick: float) -> Any:
        """The bones as lines, `thick` relative to the arm."""
        bones = skeleton(self.derivation.reading.dh, q).bones
        points = np.array([[bone.start, bone.end] for bone in bones], dtype=np.float32)
        return self.server.scene.add_line_segments(
            name,
            points,
            np.broadcast_to(np.array(colour, dtype=np.uint8), points.shape),
            thickness=self.size * thick,
        )
