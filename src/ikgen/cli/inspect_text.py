"""What `ikgen inspect` found, as text."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ikgen.cli.braille import skeleton_text
from ikgen.cli.tables import table
from ikgen.cli.tree_text import dh_table, joint_tree, transform_text
from ikgen.model.counted import counted, listed
from ikgen.model.dh import ARM_ANGLE_OPTION

if TYPE_CHECKING:
    from ikgen.derivation.advice import Attempt
    from ikgen.derivation.inspection import Inspection
    from ikgen.kinematics.classify import GeometryClass
    from ikgen.model.dh import DHChain

__all__ = ["as_text"]

_PROPOSED = 4


def as_text(found: Inspection) -> str:
    """For people."""
    parts = []
    if found.tree is not None:
        parts.append(f"robot '{found.tree.name}'\n{joint_tree(found.tree)}")
        parts.append(_chains(found))
    if found.dh is not None and found.geometry is not None:
        parts += _chain(found.dh, found.geometry)
        if found.calibration is not None:
            parts.append(f"calibrated: {found.calibration.words}")
        if found.taken is None and found.dh.snaps:
            parts.append("a closed form may do with less: derivations tell")
        parts.append(_advice(found))
    return "\n\n".join(part for part in parts if part)


def _chains(found: Inspection) -> str:
    if not found.candidates:
        return "chains: none found; choose the ends by --base and --tip"
    lines = ["chains:"]
    for c in found.candidates:
        lines.append(f"  --base {c.base} --tip {c.tip}   {counted(c.dof, 'joint')}; {c.why}")
        lines.append(f"      {c.words}")
        if c.other_tips:
            lines.append(f"      other tips, fixed to it: {listed(c.other_tips)}")
        if c.left_out and found.reading is None:
            lines.append(f"      {c.left_out}")
    if found.other_ends:
        ends = listed(found.other_ends)
        lines.append(
            f"  taken for fingers or side branches: {ends}; --tip LINK takes one for an arm"
        )
    if found.reading is None:
        lines.append("several chains: choose one by --base and --tip to see more")
    return "\n".join(lines)


def _chain(dh: DHChain, geometry: GeometryClass) -> list[str]:
    """The DH table with the transforms around it, the geometry and what was snapped."""
    held = f", locked: {', '.join(n for n, _ in dh.locked)}" if dh.locked else ""
    head = f"chain {dh.base_link} -> {dh.tip_link}, {counted(dh.dof, 'joint')}{held}"
    ends = table(
        [("base:", *transform_text(dh.X_base)), ("tool:", *transform_text(dh.X_tip))],
    )
    parts = [
        f"{head}\n{skeleton_text(dh)}",
        f"modified DH rows:\n{dh_table(dh)}",
        f"before the first row and after the last (m, rad):\n{ends}",
        f"geometry: {geometry.words}",
        *_motors(dh),
    ]
    metres, radians = dh.deviation
    if dh.snaps:
        rows = [(s.what, s.texts[0], "->", s.texts[1]) for s in dh.snaps]
        cost = f"moves the tip by at most {1e3 * metres:.2g} mm and {radians:.2g} rad"
        parts.append(f"taken as exact ({cost}):\n{table(rows)}")
    else:
        parts.append("taken as exact: nothing")
    return parts + _kept(dh)


def _motors(dh: DHChain) -> list[str]:
    """What motors move the joints by, where several move one."""
    if dh.transmission is None:
        return []
    lines = "\n".join(f"  {one}" for one in dh.transmission.words([j.name for j in dh.joints]))
    return [f"joints of motors, which the solver's values are of:\n{lines}"]


def _kept(dh: DHChain) -> list[str]:
    """Constants that the closed form takes as they are."""
    from ikgen.kinematics.kept import kept_constants

    rows = [(s.what, s.texts[0], "for", s.texts[1]) for s in kept_constants(dh)]
    return [f"kept as in the file:\n{table(rows)}"] if rows else []


def _advice(found: Inspection) -> str:
    """What to do next."""
    lines = ["advice:"]
    if found.moving < 6:
        lines.append(
            f"  {counted(found.moving, 'joint move')}, so a pose cannot be chosen freely: see --task"
        )
    for k, attempt in enumerate(found.closed):
        if k < _PROPOSED or attempt.default:
            lines += _proposal(attempt)
    lines += _tip(found)
    if found.arm_angle:
        lines.append(
            f"  --free {ARM_ANGLE_OPTION}: closed form, the angle of the elbow held in a joint's place"
        )
    if found.hindrance is not None:
        lines += [f"  {found.hindrance.message}", f"      {found.hindrance.hint}"]
    if found.attempts and not found.closed:
        best = max(found.attempts, key=lambda attempt: len(attempt.order))
        lines.append(
            f"  no closed form found for the task '{best.task}': left are {', '.join(best.left)}"
        )
    return "\n".join(lines) if len(lines) > 1 else ""


def _tip(found: Inspection) -> list[str]:
    """What the tip's place makes of the task that is taken without options."""
    from ikgen.derivation.tip_on_axis import tip_on_axis
    from ikgen.tasks import find_task

    taken = found.taken
    if taken is None or taken.dh is None or found.reading is None or not taken.default:
        return []
    words = tip_on_axis(taken.dh, find_task(taken.task), found.reading.source.has_links)
    return [f"  {words}"] if words else []


def _proposal(attempt: Attempt) -> list[str]:
    """A closed form: the options to type, how many solutions, in which order, and what is weak in it."""
    options = attempt.options or "as it is"
    if attempt.default:
        options = f"without options, which is {options}"
    closed = "closed form" if not attempt.weak else "closed form with a weak step"
    lines = [f"  {options}: {closed}, at most {counted(attempt.max_solutions, 'solution')}"]
    lines.append(f"      {'; '.join(attempt.order)}")
    lines += [f"      ranked by {attempt.ranking}"] if attempt.ranking else []
    if attempt.weak:
        lines.append(
            f"      weak: {', '.join(attempt.weak)} fails at some regular configurations, with no other "
            "form to fall back on; the verification may refuse it"
        )
    return lines
