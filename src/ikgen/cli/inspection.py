"""What `ikgen inspect` found, as text and as a dictionary."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ikgen.cli.tables import table
from ikgen.cli.tree_text import angle_text, constants, dh_table, joint_tree, length_text

if TYPE_CHECKING:
    from ikgen.chains.arms import ChainCandidate
    from ikgen.generation.advice import Attempt
    from ikgen.generation.pipeline import Reading
    from ikgen.model.dh import DHChain, DHRow
    from ikgen.model.joint_tree import JointTree

__all__ = ["Findings", "as_dict", "as_text"]

_PROPOSED = 4


@dataclass(frozen=True, slots=True)
class Findings:
    """`reading` is None where it is not clear which chain is meant, `tree` for a DH table."""

    reading: Reading | None
    tree: JointTree | None
    candidates: tuple[ChainCandidate, ...]
    attempts: list[Attempt]

    @property
    def warnings(self) -> tuple[str, ...]:
        """What was odd in the file."""
        if self.tree is not None:
            return self.tree.source.warnings
        return self.reading.source.warnings if self.reading is not None else ()


def as_text(findings: Findings) -> str:
    """For people."""
    parts = []
    if findings.tree is not None:
        parts.append(f"robot '{findings.tree.name}'\n{joint_tree(findings.tree)}")
        parts.append(_chains(findings))
    if findings.reading is not None:
        parts += _chain(findings.reading.dh)
        parts.append(_advice(findings, findings.reading.dh))
    return "\n\n".join(part for part in parts if part)


def _chains(findings: Findings) -> str:
    if not findings.candidates:
        return "chains: none found; choose the ends by --base and --tip"
    lines = ["chains:"]
    for c in findings.candidates:
        lines.append(f"  --base {c.base} --tip {c.tip}   {c.dof} joints; {c.why}")
        lines.append(f"      {', '.join(c.joints)}")
    if findings.reading is None:
        lines.append("several chains: choose one by --base and --tip to see more")
    return "\n".join(lines)


def _chain(dh: DHChain) -> list[str]:
    """The DH table, the geometry and what was snapped."""
    from ikgen.kinematics.classify import classify

    held = f", locked: {', '.join(n for n, _ in dh.locked)}" if dh.locked else ""
    head = f"chain {dh.base_link} -> {dh.tip_link}, {dh.dof} joints{held}"
    parts = [
        f"{head}\nmodified DH rows (rad, m):\n{dh_table(dh)}",
        f"geometry: {classify(dh).words}",
    ]
    metres, radians = dh.deviation
    if dh.snaps:
        rows = [(s.what, f"{s.before:.12g}", "->", f"{s.after:.12g}") for s in dh.snaps]
        cost = f"moves the tip by at most {1e3 * metres:.2g} mm and {radians:.2g} rad"
        parts.append(f"taken as exact ({cost}):\n{table(rows)}")
        parts += _kept(dh)
    else:
        parts.append("taken as exact: nothing")
    return parts


def _kept(dh: DHChain) -> list[str]:
    """Constants that a closed form may leave as they are."""
    from ikgen.kinematics.kept import keep_constants, kept_constants, stray_lengths

    nearest = keep_constants(dh, stray_lengths(dh))
    rows = [(s.what, f"{s.before:.12g}", "for", f"{s.after:.12g}") for s in kept_constants(nearest)]
    metres, radians = nearest.deviation
    cost = f"then the tip is within {1e3 * metres:.2g} mm and {radians:.2g} rad"
    lead = f"kept as in the file where the closed form can do with them ({cost})"
    return [f"{lead}:\n{table(rows)}"] if rows else []


def _advice(findings: Findings, dh: DHChain) -> str:
    """What to do next."""
    lines = ["advice:"]
    moving = dh.dof - len(dh.free)
    if moving < 6:
        lines.append(f"  {moving} joints move, so a pose cannot be chosen freely: see --task")
    if moving > 7 and not findings.attempts:
        lines.append(f"  {moving} joints move: hold {moving - 6} of them (--free or --lock)")
    closed = [attempt for attempt in findings.attempts if attempt.closed]
    for attempt in closed[:_PROPOSED]:
        options = attempt.options or "as it is"
        lines.append(f"  {options}: closed form, at most {attempt.max_solutions} solutions")
        lines.append(f"      {'; '.join(attempt.order)}")
    if findings.attempts and not closed:
        best = max(findings.attempts, key=lambda attempt: len(attempt.order))
        lines.append(
            f"  no closed form found for the task '{best.task}': left are {', '.join(best.left)}"
        )
    return "\n".join(lines) if len(lines) > 1 else ""


def as_dict(findings: Findings) -> dict[str, Any]:
    """For --json."""
    record: dict[str, Any] = {"warnings": list(findings.warnings)}
    if findings.tree is not None:
        record["robot"] = findings.tree.name
        record["root"] = findings.tree.root_link
        record["joints"] = [
            {
                "name": j.name,
                "type": j.type.value,
                "parent": j.parent,
                "child": j.child,
                "limits": [_finite(j.limits.lower), _finite(j.limits.upper)],
                "mimic": None if j.mimic is None else j.mimic.joint,
            }
            for j in findings.tree.joints
        ]
        record["candidates"] = [
            {"base": c.base, "tip": c.tip, "dof": c.dof, "joints": list(c.joints), "why": c.why}
            for c in findings.candidates
        ]
    if findings.reading is not None:
        record["chain"] = _chain_dict(findings.reading.dh)
    record["attempts"] = [
        {
            "task": a.task,
            "free": list(a.free),
            "closed": a.closed,
            "max_solutions": a.max_solutions,
            "order": list(a.order),
            "left": list(a.left),
            "options": a.options,
        }
        for a in findings.attempts
    ]
    return record


def _chain_dict(dh: DHChain) -> dict[str, Any]:
    from ikgen.kinematics.classify import classify
    from ikgen.kinematics.kept import keep_constants, kept_constants, stray_lengths

    geometry = classify(dh)
    kept = kept_constants(keep_constants(dh, stray_lengths(dh))) if dh.snaps else ()
    return {
        "base": dh.base_link,
        "tip": dh.tip_link,
        "dof": dh.dof,
        "joints": [joint.name for joint in dh.joints],
        "geometry": {"name": geometry.name, "words": geometry.words},
        "dh": [_row_dict(row) for row in dh.rows],
        "constants": constants(dh),
        "snaps": [{"what": s.what, "before": s.before, "after": s.after} for s in dh.snaps],
        "kept": [{"what": s.what, "value": s.before, "meant": s.after} for s in kept],
        "deviation": {"m": dh.deviation[0], "rad": dh.deviation[1]},
    }


def _row_dict(row: DHRow) -> dict[str, Any]:
    return {
        "name": row.name,
        "type": row.kind,
        "alpha": {"text": angle_text(row.alpha), "value": row.alpha.value},
        "a": {"text": length_text(row.a), "value": row.a.value},
        "d": {"text": length_text(row.d), "value": row.d.value},
        "theta": {"text": angle_text(row.theta), "value": row.theta.value},
        "scale": row.scale,
        "offset": row.offset.value,
    }


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
