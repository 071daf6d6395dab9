"""Proofs of the derivations that checked outputs come from."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from ikgen import __version__
from ikgen.projects.check_findings import Finding, Recheck

if TYPE_CHECKING:
    from ikgen.derivation.progress import Progress
    from ikgen.symbolic.proof import Proof

__all__ = ["proved"]


def proved(result: Recheck, robot: Path | None, progress: Progress) -> Recheck:
    """The result of a record whose outputs are right, with the proof of the derivation that this version
    makes of its description. What is wrong is a finding, what could not be proved none."""
    record = result.record
    if record is None or not result.passed:
        return result
    from ikgen.derivation.derive import derive
    from ikgen.symbolic import prove

    progress("prove", record.name)
    proof = prove(derive(record.again(robot)))
    notes = result.notes
    if record.version != __version__:
        notes += (f"made by ikgen {record.version}, proved as ikgen {__version__} derives it",)
    return replace(result, proof=proof, notes=notes, findings=_wrong(proof, result.path))


def _wrong(proof: Proof, path: Path) -> tuple[Finding, ...]:
    return tuple(
        Finding(
            path,
            f"its derivation does not hold: {one.label}: {one.reason}",
            hint="please report it",
        )
        for one in (*proof.equations, *proof.patterns)
        if one.wrong
    )
