"""Plain text tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ikgen.verify.verification_report import VerificationReport

__all__ = ["table", "verification_tables"]


def table(rows: Sequence[Sequence[str]], indent: str = "  ") -> str:
    """Rows as aligned columns; a row of one cell is a heading."""
    wide = [row for row in rows if len(row) > 1]
    widths = [max(len(row[i]) for row in wide) for i in range(len(wide[0]))] if wide else []
    lines = []
    for row in rows:
        if len(row) == 1:
            lines.append(row[0])
            continue
        cells = (cell.ljust(width) for cell, width in zip(row, widths, strict=True))
        lines.append((indent + "  ".join(cells)).rstrip())
    return "\n".join(lines)


def verification_tables(reports: Mapping[str, VerificationReport]) -> str:
    """All checks of all languages; failed ones with their case."""
    parts = []
    for name, report in reports.items():
        parts.append(f"verification of the {name} output, {report.samples} random poses:")
        parts.append(table([("check", "", "things", "largest deviation", ""), *report.table()]))
        parts += [f"  {check.name}: {check.worst_case}" for check in report.failed]
        parts += [f"  note: {note}" for note in report.notes]
    return "\n".join(parts)
