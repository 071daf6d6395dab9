"""What pages say of messages, commands and extras holds."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from tests.support.snippets import blocks

from ikgen.cli.main import COMMANDS

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"


def test_messages_are_those_of_the_program() -> None:
    """Every line that the page on messages quotes is in the source."""
    source = "\n".join(p.read_text(encoding="utf-8") for p in (ROOT / "src").rglob("*.py"))
    plain = re.sub(r'"\s*\n\s*f?"', "", source)
    quoted = [
        line
        for block in blocks(DOCS / "how-to/troubleshooting.md")
        for line in block.text.splitlines()
    ]
    assert len(quoted) >= 2
    for line in quoted:
        assert line in plain, line


@pytest.mark.parametrize("page", sorted(DOCS.rglob("*.md")), ids=lambda path: path.name)
def test_commands_that_pages_name_exist(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    fenced = [block.text for block in blocks(page) if block.language in ("sh", "console")]
    named = set(re.findall(r"`ikgen ([a-z][a-z-]+)", text))
    named |= set(re.findall(r"^(?:\$ )?ikgen ([a-z][a-z-]+)", "\n".join(fenced), re.M))
    assert named <= set(COMMANDS), named - set(COMMANDS)


def test_extras_that_pages_name_exist() -> None:
    project = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    text = "\n".join(page.read_text(encoding="utf-8") for page in DOCS.rglob("*.md"))
    extras = set(re.findall(r"ikgen\[(\w+)\]", text))
    assert {"view", "dask"} <= extras
    for extra in extras:
        assert re.search(rf"^{extra} = \[", project, re.M), extra
