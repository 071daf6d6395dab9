"""What a finished generation says: a few lines for people, a dictionary for machines."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from ikgen.cli.tables import table, verification_tables

if TYPE_CHECKING:
    from ikgen.generation.generation import Generation
    from ikgen.generation.pipeline import Derivation
    from ikgen.solver.solution_graph import SolutionGraph
    from ikgen.verify.verification_report import VerificationReport

__all__ = ["as_dict", "summary", "trace"]


def summary(generation: Generation) -> str:
    """The result in a few lines."""
    derivation = generation.derivation
    module, dh = derivation.module, derivation.reading.dh
    held = [dh.joints[j].name for j in module.free]
    lines = [
        ("robot", f"{dh.robot}, {dh.base_link} -> {dh.tip_link}, {dh.dof} joints"),
        ("task", _task(derivation) + (f", held: {', '.join(held)}" if held else "")),
        ("geometry", derivation.geometry.words + _rounding(derivation)),
        ("solved", "; ".join(module.order)),
        ("solutions", _solutions(generation)),
    ]
    lines += [("verified", _verified(name, r)) for name, r in generation.reports.items()]
    if not generation.reports:
        lines.append(("verified", "no"))
    if dh.symbols:
        words = "; verified with sample numbers" if generation.reports else ""
        lines.append(("fill in", f"{', '.join(dh.symbols)}{words}"))
    lines += [("wrote", str(path)) for path in generation.files]
    lines.append(("time", f"{generation.seconds:.1f} s"))
    return table([(f"{name}:", text) for name, text in lines], indent="")


def _task(derivation: Derivation) -> str:
    """The task, and that it was chosen where another might be expected."""
    task = derivation.task
    if not derivation.chosen or task.whole_pose:
        return task.words
    return f"{task.words} (--task {task.name}: what fits {derivation.reading.dh.dof} joints)"


def _rounding(derivation: Derivation) -> str:
    """How far the file is off what was solved, where Newton steps take the rows to it."""
    metres, radians = derivation.reading.dh.deviation
    if derivation.module.polish == "some":
        return ""
    return (
        f"; the file's is up to {1e3 * metres:.2g} mm and {radians:.1g} rad off, its rows are exact"
    )


def _solutions(generation: Generation) -> str:
    """How many solutions there are at most, and over the random poses."""
    most = f"at most {generation.derivation.module.max_solutions}"
    for report in generation.reports.values():
        least, mean, greatest = report.solutions
        return f"{most}; {least} / {mean:.1f} / {greatest} (min / mean / max of random poses)"
    return most


def _verified(name: str, report: VerificationReport) -> str:
    metres, radians = report.worst_closure
    return (
        f"{name}: {report.samples} poses, worst closure {metres:.1e} m {radians:.1e} rad, "
        f"{_missed(report)} missed, {report.seconds:.1f} s"
    )


def _missed(report: VerificationReport) -> int:
    """Generating configurations and searched ones that no row gives."""
    names = ("completeness", "exhaustive search")
    return sum(check.failures for check in report.checks if check.name in names)


def as_dict(generation: Generation) -> dict[str, Any]:
    """For --json."""
    derivation = generation.derivation
    module, dh = derivation.module, derivation.reading.dh
    return {
        "name": module.name,
        "robot": dh.robot,
        "base": dh.base_link,
        "tip": dh.tip_link,
        "task": module.task,
        "joints": [joint.name for joint in dh.joints],
        "free": [dh.joints[j].name for j in module.free],
        "locked": dict(dh.locked),
        "symbols": list(dh.symbols),
        "geometry": {"name": derivation.geometry.name, "words": derivation.geometry.words},
        "solved": [
            {"unknown": s.candidate.unknown.text, "leaf": s.candidate.leaf, "branches": s.branches}
            for s in derivation.graph.steps
        ],
        "max_solutions": module.max_solutions,
        "deviation": {"m": dh.deviation[0], "rad": dh.deviation[1]},
        "warnings": list(derivation.reading.source.warnings),
        "files": [str(path) for path in generation.files],
        "verification": {name: _report(r) for name, r in generation.reports.items()},
        "seconds": round(generation.seconds, 3),
    }


def _report(report: VerificationReport) -> dict[str, Any]:
    closure = [x if math.isfinite(x) else None for x in report.worst_closure]
    return {
        **report.to_dict(),
        "worst_closure": {"m": closure[0], "rad": closure[1]},
        "missed": _missed(report),
        "seconds": round(report.seconds, 3),
    }


def trace(generation: Generation) -> str:
    """For -v: every tick, the ranker's choices, every check."""
    graph = generation.derivation.graph
    parts = ["behaviour tree:"]
    for number in sorted({t.round for t in graph.ticks}):
        parts += [f"round {number}", table(_round(graph, number))]
    parts.append("choices:")
    for step in graph.steps:
        chosen = step.candidate
        parts.append(f"  {chosen.unknown.text}: {chosen.leaf}, {chosen.form.name}{_judged(chosen)}")
        parts += [f"    fallback: {c.leaf}, {c.form.name}{_judged(c)}" for c in step.fallbacks]
        parts += [f"    rejected: {c.leaf}, {c.form.name}{_judged(c)}" for c in step.rejected]
    if generation.reports:
        parts.append(verification_tables(generation.reports))
    return "\n".join(parts)


def _round(graph: SolutionGraph, number: int) -> list[tuple[str, ...]]:
    """The nodes that were ticked in one round, indented as in the tree."""
    ticks = {t.path: t for t in graph.ticks if t.round == number}
    rows: list[tuple[str, ...]] = []
    for path in graph.outline:
        if path in ticks:
            t = ticks[path]
            name = "  " * (len(path) - 1) + t.node.rpartition(": ")[2]
            spent = f"{1e3 * t.seconds:.1f} ms" if t.kind == "leaf" else f"({t.kind})"
            rows.append((name, t.outcome, spent, t.detail))
    return rows


def _judged(candidate: Any) -> str:
    judgement = candidate.judgement
    if judgement is None:
        return ""
    weak = ", weak" if judgement.weak else ""
    return f" (margin {judgement.margin:.1e}, cost {judgement.cost:g}{weak})"
