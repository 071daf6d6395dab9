"""What stages hand on: a description as read, and what was derived from it."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import zip_longest
from typing import TYPE_CHECKING

from ikgen.model.joint_relation import Mimic

if TYPE_CHECKING:
    from ikgen.emit.solver_module import SolverModule
    from ikgen.kinematics.calibrated import Calibration
    from ikgen.kinematics.classify import GeometryClass
    from ikgen.model.chain import Chain
    from ikgen.model.dh import DHChain
    from ikgen.model.joint_tree import JointTree, Source
    from ikgen.solver.solution_graph import SolutionGraph
    from ikgen.tasks import Task

__all__ = ["Derivation", "Held", "Reading", "Unsolved"]


@dataclass(frozen=True, slots=True)
class Reading:
    """A description as read: its tree and chain (none for a DH table) and the chain in DH form. `coupled`
    are the relations between joints that were chosen, not asked for (`JOINT=SOURCE*k+c`), `relations`
    those asked for or chosen, but of motors; `parts` are joints of the chain that are not the robot's,
    each a part of the value of one that follows several; `calibration` is there where the chain is one
    arm's own."""

    source: Source
    tree: JointTree | None
    chain: Chain | None
    dh: DHChain
    coupled: tuple[str, ...] = ()
    parts: tuple[str, ...] = ()
    calibration: Calibration | None = None
    relations: tuple[str, ...] = ()

    @property
    def followers(self) -> tuple[str, ...]:
        """The joints that follow others by the file itself (`JOINT=SOURCE*k+c`)."""
        chain = self.chain
        if chain is None:
            return ()
        joints = [joint.name for joint in chain.joints]
        told = {text.partition("=")[0] for text in self.relations}
        others = {*joints, *self.parts, *told}
        return tuple(
            f"{axis.name}={Mimic(joints[axis.driver], axis.multiplier, axis.offset).words}"
            for axis in chain.file_axes or chain.axes
            if axis.name not in others
        )


@dataclass(frozen=True, slots=True)
class Held:
    """Joints that were chosen to be held, base to tip, why, the choices that came next, those before that
    the verification refused, and what put each of the `others` behind ("" where that is not known);
    `shared` are joints that move and carry other arms too, `idle` those held that hardly move."""

    joints: tuple[str, ...]
    why: str
    others: tuple[tuple[str, ...], ...] = ()
    refused: tuple[tuple[str, ...], ...] = ()
    behind: tuple[str, ...] = ()
    shared: tuple[str, ...] = ()
    idle: tuple[str, ...] = ()

    @property
    def words(self) -> str:
        """One line."""
        it = "it" if len(self.joints) == 1 else "them"
        named = " and ".join(f"{x}{' (hardly moves)' * (x in self.idle)}" for x in self.joints)
        line = f"holding {named}: {self.why} with {it} held"
        told = (("others", self.others, self.behind), ("failed verification", self.refused, ()))
        for kind, names, reasons in told:
            words = zip_longest(map(" and ".join, names), reasons, fillvalue="")
            listed = [f"{name} ({reason})" if reason else name for name, reason in words]
            line += f"; {kind}: {', '.join(listed)}" if listed else ""
        if self.shared:
            carry, it = ("carries", "it") if len(self.shared) == 1 else ("carry", "one of them")
            line += f"; {' and '.join(self.shared)} {carry} other branches of the robot too"
            line += f": --free NAME holds {it} in place of another"
        return line


@dataclass(frozen=True, slots=True)
class Derivation:
    """Everything between the file and the emitted text."""

    reading: Reading
    geometry: GeometryClass
    task: Task
    graph: SolutionGraph
    module: SolverModule
    again: str
    """The command that makes its report again, where the description lies."""
    chosen: bool = False
    """Whether the task was chosen to fit the arm, not asked for."""
    held: Held | None = None
    """The joints that were chosen to be held; None where none was."""
    passed_over: tuple[str, ...] = ()
    """Tasks that came before the chosen one, and whose code failed its verification."""
    file_class: str = ""
    """The name of the geometry class of the file's own chain, which that of what was solved may not be."""


@dataclass(frozen=True, slots=True)
class Unsolved:
    """How far a derivation came that found no closed form; `name` is its module's, `again` the command that
    makes its report again, where the description lies."""

    reading: Reading
    geometry: GeometryClass
    task: Task
    graph: SolutionGraph
    name: str
    source_name: str
    again: str
