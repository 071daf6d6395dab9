"""DH tables (modified) as files, from a few numbers a joint."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

__all__ = ["Row", "dh_file"]

Row = tuple[str, str | float, float, float, str | float]
"""Kind; alpha (rad), an expression where it is a text; a and d (m); theta (rad)."""


def dh_file(path: Path, rows: Iterable[Row], *, limit: float | None = None, ends: str = "") -> Path:
    """The table of that name, its joints without limits or with `limit` (rad, m) to either side; `ends`:
    its base and tool, as TOML."""
    text = f'name = "{path.stem}"\nconvention = "modified"\n'
    for kind, alpha, a, d, theta in rows:
        twist, turn = (f'"{x}"' if isinstance(x, str) else repr(x) for x in (alpha, theta))
        text += (
            f'[[joints]]\ntype = "{kind}"\nalpha = {twist}\na = {a!r}\nd = {d!r}\ntheta = {turn}\n'
        )
        text += "" if limit is None else f"limits = [{-limit}, {limit}]\n"
    path.write_text(text + ends, encoding="utf-8")
    return path
