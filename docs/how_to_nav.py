"""Hook of mkdocs: the pages of how-to/, those about adding to ikgen last."""

from __future__ import annotations

from pathlib import Path
from typing import Any

__all__ = ["on_config"]


def on_config(config: Any) -> None:
    """Fill the section "How to" in."""
    folder = Path(config.docs_dir) / "how-to"
    names = sorted(
        (path.name for path in folder.glob("*.md")), key=lambda n: (n.startswith("add-"), n)
    )
    section = next(part for part in config.nav if "How to" in part)
    section["How to"] = [f"how-to/{name}" for name in names]
