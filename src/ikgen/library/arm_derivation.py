"""How an arm's inverse kinematics was derived, to look at."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from ikgen.library.argument_words import argument_words, in_argument_words

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ikgen.emit.derivation import Derivation
    from ikgen.kinematics.classify import GeometryClass
    from ikgen.library.solver_cache import SolverEntry
    from ikgen.model.dh import DHChain
    from ikgen.records.request import Request
    from ikgen.solver.session import Tick
    from ikgen.solver.solution_graph import SolutionGraph

__all__ = ["ArmDerivation", "derived_again"]


@dataclass(frozen=True, slots=True, repr=False)
class ArmDerivation:
    """What lies between the robot's file and the solver; `whole` is all of it, as the stages hand it on."""

    whole: Derivation

    @property
    def geometry(self) -> GeometryClass:
        """The family of the arm: its `name`, its `words`, and the facts behind them."""
        return self.whole.geometry

    @property
    def dh(self) -> DHChain:
        """The chain in modified Denavit-Hartenberg form; `dh.rows` is the table."""
        return self.whole.reading.dh

    @property
    def graph(self) -> SolutionGraph:
        """The unknowns in the order solved, with their formulas and parents."""
        return self.whole.graph

    @property
    def order(self) -> tuple[str, ...]:
        """The unknowns in the order solved, each with the leaf that solved it."""
        return self.whole.module.order

    @property
    def trace(self) -> tuple[Tick, ...]:
        """What each node of the behavior tree did, in order."""
        return self.whole.graph.ticks

    @property
    def held(self) -> str:
        """Which joints ikgen chose to hold, and why; "" where it chose none."""
        return "" if self.whole.held is None else argument_words(self.whole.held.words)

    @property
    def solutions(self) -> Mapping[Any, Any]:
        """SymPy: joint variable -> its branches, each with its conditions, in terms of the pose's entries
        and of earlier unknowns."""
        found: Mapping[Any, Any] = _symbolic().solutions(self.whole)
        return found

    @property
    def equations(self) -> tuple[Any, ...]:
        """SymPy: an `Eq` of every matrix equation that was used."""
        found: tuple[Any, ...] = _symbolic().equations(self.whole)
        return found

    def __repr__(self) -> str:
        """The arm, its family and the order of solution: all that `whole` holds would be 100 kB."""
        name, order = self.whole.module.name, "; ".join(self.order)
        return f"<ikgen derivation of {name}: {self.geometry.name}, {order}>"

    def proof(self) -> Any:
        """Which of the equations and formulas are proved in exact arithmetic, and why others are not."""
        return _symbolic().prove(self.whole)


def _symbolic() -> Any:
    """The package that speaks SymPy, imported where it is asked for."""
    from ikgen import symbolic

    return symbolic


@in_argument_words()
def derived_again(request: Request, entry: SolverEntry) -> Derivation:
    """The derivation of a solver that was made before: the same description gives the same."""
    from ikgen.derivation.derive import derive

    derivation = derive(request, passed_over=entry.passed_over, refused=entry.refused)
    name = request.name or entry.name
    return replace(derivation, module=replace(derivation.module, name=name))
