"""What came of checking outputs: what is wrong, and what could not be checked."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from ikgen.errors import BadDescriptionError, IkgenError
from ikgen.records.record import SUFFIX, Record

if TYPE_CHECKING:
    from ikgen.symbolic.proof import Proof
    from ikgen.verify.verification_report import VerificationReport

__all__ = ["HALF_IN_PLACE", "Finding", "Recheck", "unchecked"]

HALF_IN_PLACE = "a killed run left its files half in place"


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing that is wrong: about which file, what, and what puts it right: a `command` to type, or
    where there is none ("") a `hint` in words; `deviation` (m, rad) of the forward kinematics where those
    are another geometry's. `exit_code` is 1 for wrong outputs, else that of the error that kept them from
    being checked."""

    file: Path
    message: str
    command: str = ""
    deviation: tuple[float, float] | None = None
    exit_code: int = 1
    line: int = 1
    hint: str = ""

    @property
    def remedy(self) -> str:
        """What puts it right, whichever there is."""
        return self.command or self.hint


@dataclass(frozen=True, slots=True)
class Recheck:
    """What came of one record: findings (none: all is right), notes and the verifications, and the proof
    where one was asked for; `record` is None where its file `path` could not be read."""

    path: Path
    record: Record | None
    findings: tuple[Finding, ...] = ()
    notes: tuple[str, ...] = ()
    reports: Mapping[str, VerificationReport] = field(default_factory=dict)
    proof: Proof | None = None

    @property
    def passed(self) -> bool:
        """Whether nothing is wrong."""
        return not self.findings

    @property
    def exit_code(self) -> int:
        """The worst of the findings'."""
        return max((finding.exit_code for finding in self.findings), default=0)

    @property
    def name(self) -> str:
        """The arm's name; by the record's file name where the record cannot be read."""
        return self.record.name if self.record else self.path.name.removesuffix(SUFFIX)


def unchecked(path: Path, record: Record | None, error: IkgenError) -> Recheck:
    """The outcome of a record that an error kept from being checked."""
    named = error.file if isinstance(error, BadDescriptionError) else ""
    line = (error.line if isinstance(error, BadDescriptionError) else None) or 1
    file = Path(named) if named else path
    finding = Finding(file, error.message, exit_code=error.exit_code, line=line, hint=error.hint)
    return Recheck(path, record, (finding,))
