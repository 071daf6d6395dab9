"""What a description holds and what can be done with it: what `ikgen inspect` shows."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from ikgen.derivation.advice import attempts
from ikgen.derivation.held_needs import check_task, rounding_decides
from ikgen.derivation.idle_solved import idle_warning
from ikgen.derivation.lost_freedom import lost_freedom
from ikgen.derivation.progress import Progress, silent
from ikgen.derivation.read import has_arm_angle, read, read_tree
from ikgen.errors import UnsolvedChainError
from ikgen.tasks import POSE, find_task

if TYPE_CHECKING:
    from ikgen.chains.arms import ChainCandidate
    from ikgen.derivation.advice import Attempt
    from ikgen.emit.derivation import Reading
    from ikgen.errors import IkgenError
    from ikgen.kinematics.calibrated import Calibration
    from ikgen.kinematics.classify import GeometryClass
    from ikgen.model.dh import DHChain
    from ikgen.model.joint_tree import JointTree
    from ikgen.records.request import Request

__all__ = ["Inspection", "inspect_robot"]


@dataclass(frozen=True, slots=True)
class Inspection:
    """`reading` and its `geometry` are None where it is not clear which chain is meant, `tree` for a DH
    table; `attempts` are derivations that were tried, best first, `hindrance` why none was. The geometry is
    that of `dh`. `other_ends`: the last links of branches that are taken for no arm's."""

    reading: Reading | None
    geometry: GeometryClass | None
    tree: JointTree | None
    candidates: tuple[ChainCandidate, ...]
    attempts: tuple[Attempt, ...]
    hindrance: IkgenError | None = None
    other_ends: tuple[str, ...] = ()

    @property
    def taken(self) -> Attempt | None:
        """The closed form that is generated where no other task or joint is asked for; None where none was
        found."""
        closed = self.closed
        return next((one for one in closed if one.default), closed[0] if closed else None)

    @property
    def dh(self) -> DHChain | None:
        """The rows that are generated from; before any derivation those of the exact geometry."""
        taken = self.taken
        if taken is not None and taken.dh is not None:
            return taken.dh
        return self.reading.dh if self.reading is not None else None

    @property
    def calibration(self) -> Calibration | None:
        """What there is to tell of the one arm's own rows, where these are."""
        return None if self.reading is None else self.reading.calibration

    @property
    def closed(self) -> tuple[Attempt, ...]:
        """The attempts that found a closed form."""
        return tuple(attempt for attempt in self.attempts if attempt.closed)

    @property
    def arm_angle(self) -> bool:
        """Whether the arm angle can be held in a joint's place: only poses are solved so."""
        held = self.closed and self.closed[0].held and self.closed[0].task == POSE.name
        return bool(held) and self.reading is not None and has_arm_angle(self.reading)

    @property
    def moving(self) -> int:
        """How many joints of the chain are not held."""
        return self.reading.dh.moving if self.reading else 0

    @property
    def warnings(self) -> tuple[str, ...]:
        """What was odd in the file, that joints are not independent, or that some hardly move."""
        if self.reading is not None:
            lost = lost_freedom(self.reading, self.reading.dh.free)
            idle, taken = "", self.taken
            if taken is not None and taken.dh is not None:
                idle = idle_warning(taken.dh, find_task(taken.task))
            return (*self.reading.source.warnings, *filter(None, [lost, idle]))
        return self.tree.source.warnings if self.tree is not None else ()


def inspect_robot(
    request: Request, progress: Progress = silent, *, advice: bool = True
) -> Inspection:
    """Read the file; the chain and what follows from it where it is clear which one."""
    from ikgen.chains.arms import candidate_chains
    from ikgen.chains.other_ends import other_ends
    from ikgen.kinematics.classify import classify
    from ikgen.kinematics.whole_turns import check_couplings

    progress("read", request.robot.name)
    tree: JointTree | None = None
    candidates: tuple[ChainCandidate, ...] = ()
    ends: tuple[str, ...] = ()
    reading: Reading | None = None
    if request.table:
        reading = read(request)
    else:
        tree = read_tree(request)
        candidates = candidate_chains(tree, request.base)
        ends = other_ends(tree, candidates, request.base)
        if request.tip is not None or len(candidates) == 1:
            reading = read(request, tree)
    tried: list[Attempt] = []
    hindrance: IkgenError | None = None
    if advice and reading:
        try:
            check_couplings(reading.dh)
            tried = _attempts(request, reading, progress)
        except UnsolvedChainError as error:
            hindrance = error
    found = Inspection(reading, None, tree, candidates, tuple(tried), hindrance, ends)
    return replace(found, geometry=classify(found.dh) if found.dh else None)


def _attempts(request: Request, reading: Reading, progress: Progress) -> list[Attempt]:
    """The attempts whose task `check_task` lets pass; its error where it refuses the task that is asked
    for, or the one that would be taken."""
    if request.named_task is not None:
        check_task(request, reading, find_task(request.named_task))
    tried = attempts(reading, request.named_task, progress, request.tool_axis)
    check_task(request, reading, find_task(tried[0].task))
    return [one for one in tried if not rounding_decides(reading.dh, find_task(one.task))]
