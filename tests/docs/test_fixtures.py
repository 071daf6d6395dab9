"""Every robot in the tests names its source."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
FIXTURES = ROOT / "urdf_fixtures"
TABLES = ROOT / "tests/robots/tables"


def listed(folder: Path) -> set[str]:
    """What the folder's README names in code, without file suffixes."""
    text = (folder / "README.md").read_text(encoding="utf-8")
    return {name.rstrip("/") for name in re.findall(r"`([^`\s]+)`", text)}


@pytest.mark.parametrize("folder", [FIXTURES, TABLES], ids=lambda folder: folder.name)
def test_every_robot_is_in_the_readme(folder: Path) -> None:
    names = {p.stem if folder == TABLES else p.name for p in folder.iterdir()} - {
        "README.md",
        "README",
    }
    assert len(names) > 10
    assert names <= listed(folder), names - listed(folder)


def test_the_readme_lists_no_robot_that_is_gone() -> None:
    rows = re.findall(
        r"^\| `([^`]+)` \|", (FIXTURES / "README.md").read_text(encoding="utf-8"), re.M
    )
    assert len(rows) > 10
    assert [name for name in rows if not (FIXTURES / name).exists()] == []
