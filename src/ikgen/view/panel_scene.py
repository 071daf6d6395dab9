"""What the panels beside the scene see of it."""

from __future__ import annotations

from typing import Any, Protocol

from ikgen.emit.derivation import Derivation
from ikgen.model.arrays import Array
from ikgen.verify.runners.python_module import PythonModule

__all__ = ["PanelScene"]


class PanelScene(Protocol):
    """A scene with panels: the arm that it shows, and what they may do to it."""

    @property
    def server(self) -> Any:
        """viser's server, which controls and shapes are added to."""

    @property
    def derivation(self) -> Derivation:
        """How the arm was solved."""

    @property
    def runner(self) -> PythonModule:
        """The solver that answers."""

    @property
    def size(self) -> float:
        """The arm's size (m)."""

    @property
    def pose(self) -> Array:
        """The target (4, 4) in the base link."""

    @property
    def held(self) -> Array | None:
        """Values (rad or m) of what is held; None for an arm that holds nothing."""

    @property
    def chosen(self) -> Array:
        """Joint values (dof,) of the chosen solution."""

    def draw(self) -> None:
        """Solve the target's pose and show what there is."""

    def show(self, q: Array) -> None:
        """One configuration (dof,) in place of the solutions, until the target moves."""
