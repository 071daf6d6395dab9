"""A finished generation as numbers and names."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from ikgen.model.counted import counted

if TYPE_CHECKING:
    from ikgen.emit.derivation import Derivation
    from ikgen.generation.generate import Generation
    from ikgen.verify.verification_report import VerificationReport

__all__ = ["as_dict", "branches_beside", "default_words", "rounding", "task_words"]


def rounding(derivation: Derivation) -> tuple[float, float] | None:
    """How far (m, rad) the file is off what was solved, where Newton steps take the rows to it; else
    None."""
    return derivation.reading.dh.deviation if derivation.module.rounded else None


def task_words(derivation: Derivation) -> str:
    """The task, and that it was chosen where another might be expected."""
    task = derivation.task
    passed = ", ".join(derivation.passed_over)
    failed = f"failed verification: {passed}" if passed else ""
    if not derivation.chosen or task.whole_pose:
        return task.words + (f" ({failed})" if failed else "")
    why = f"what fits {counted(derivation.reading.dh.moving, 'joint')}"
    why += f"; {failed}" if failed else ""
    return f"{task.words} (--task {task.name}: {why})"


def default_words(generation: Generation, of_poses: str = "of these") -> str:
    """How many random poses, called `of_poses`, have any solution with what is held at its default, and
    what finds others; "" where nothing is held, or nothing was verified."""
    report = next(iter(generation.reports.values()), None)
    answered, poses = report.by_default if report is not None else (0, 0)
    if not poses:
        return ""
    values = generation.derivation.module.free_defaults
    held = zip(generation.derivation.reading.dh.held, values, strict=True)
    named = ", ".join(f"{name} = {value:.3g}" for name, value in held)
    more = _elsewhere(generation.derivation) if 2 * answered < poses else ""
    return f"by default ({named}) {answered} of {poses} {of_poses} have any{more}"


def _elsewhere(derivation: Derivation) -> str:
    """What finds rows where the defaults have none; "" where no held value could change that."""
    from ikgen.derivation.idle_solved import idle_solved
    from ikgen.kinematics.idle_joints import idle_joints

    dh = derivation.reading.dh
    if idle_solved(dh, derivation.task) or set(dh.held) <= set(idle_joints(dh)):
        return ""
    if len(dh.held) == 1:
        return "; search tries other values"
    return "; search tries a grid of other values (seconds a pose in Python)"


def branches_beside(derivation: Derivation) -> tuple[str, ...]:
    """The last links of the branches beside the chain, where it was taken for the robot's only arm."""
    from ikgen.chains.arms import candidate_chains
    from ikgen.chains.other_ends import other_ends

    dh, tree = derivation.reading.dh, derivation.reading.tree
    arms = candidate_chains(tree) if tree is not None else ()
    if tree is None or [arm.tip for arm in arms] != [dh.tip_link]:
        return ()
    return other_ends(tree, arms)


def as_dict(generation: Generation) -> dict[str, Any]:
    """The result as a plain table, for --json."""
    from ikgen.derivation.announcements import announcements

    derivation = generation.derivation
    module, dh = derivation.module, derivation.reading.dh
    return {
        "name": module.name,
        "robot": dh.robot,
        "base": dh.base_link,
        "tip": dh.tip_link,
        "task": module.task,
        "joints": [joint.name for joint in dh.joints],
        "free": list(dh.held),
        "locked": dict(dh.locked),
        "coupled": list(derivation.reading.relations),
        "chosen": _chosen(derivation),
        "symbols": list(dh.symbols),
        "geometry": {"name": derivation.geometry.name, "words": derivation.geometry.words},
        "solved": [
            {"unknown": s.candidate.unknown.text, "leaf": s.candidate.leaf, "branches": s.branches}
            for s in derivation.graph.steps
        ],
        "other_ends": list(branches_beside(derivation)),
        "max_solutions": module.max_solutions,
        "deviation": {"m": dh.deviation[0], "rad": dh.deviation[1]},
        "calibration": _calibration(derivation),
        "warnings": list(announcements(derivation)),
        "files": [str(path) for path in generation.files],
        "verification": {name: _report(r) for name, r in generation.reports.items()},
        "seconds": round(generation.seconds, 3),
    }


def _calibration(derivation: Derivation) -> dict[str, Any] | None:
    """The file of the arm's own kinematics, and how far that is off the model; None without one."""
    found = derivation.reading.calibration
    if found is None:
        return None
    return {"file": found.file.as_posix(), "m": found.off[0], "rad": found.off[1]}


def _chosen(derivation: Derivation) -> dict[str, Any]:
    """What was left to ikgen and what it took: the task, relations between joints, the joints to hold, and
    why."""
    chosen: dict[str, Any] = {}
    if derivation.chosen:
        chosen["task"] = derivation.task.name
        chosen["passed_over"] = list(derivation.passed_over)
    if derivation.reading.coupled:
        chosen["coupled"] = list(derivation.reading.coupled)
    held = derivation.held
    if held is not None:
        chosen |= {"held": list(held.joints), "why": held.why}
        chosen["others"] = [list(names) for names in held.others]
        chosen["refused"] = [list(names) for names in held.refused]
        chosen["shared"] = list(held.shared)
    return chosen


def _report(report: VerificationReport) -> dict[str, Any]:
    closure = [x if math.isfinite(x) else None for x in report.worst_closure]
    return {
        **report.to_dict(),
        "worst_closure": {"m": closure[0], "rad": closure[1]},
        "seconds": round(report.seconds, 3),
    }
