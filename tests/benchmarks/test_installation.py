"""What an installation brings is counted, and the page on the library says what each package is for."""

from __future__ import annotations

import re
import sys
from pathlib import Path

from benchmarks.installation import closure, megabytes

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

ROOT = Path(__file__).resolve().parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
OTHERS = {"test", "docs", "dev", "browser", "view", "dask"}
"""Extras of developers, and those that pages of their own tell of."""
PAGE = (ROOT / "docs/reference/library.md").read_text(encoding="utf-8")


def test_packages_are_those_that_are_needed() -> None:
    plain = closure("ikgen")
    assert {"ikgen", "numpy", "pin", "libpinocchio", "pyyaml"} <= set(plain)
    assert "pytest" not in plain and "pytest" in closure("ikgen", "test")
    assert "pytest" in closure("ikgen", "dev")  # by an extra of ikgen's own
    assert megabytes([plain["numpy"]]) > 10.0


def test_the_page_names_every_package_and_what_users_may_add() -> None:
    section = PAGE.partition("## Packages\n")[2].partition("\n## ")[0]
    rows = re.findall(r"^\| (.+?) \| (.*?) \| (\d+) \|$", section, re.M)
    named = {name for cell, _, _ in rows for name in re.findall(r"[\w-]+", cell)}
    needed = {re.split(r"[>=;]", text)[0].strip() for text in PROJECT["dependencies"]} - {"tomli"}
    assert needed <= named, needed - named
    extras = set(PROJECT["optional-dependencies"]) - OTHERS
    assert extras <= named, extras - named
    total = re.search(r"26 packages of (\d+) MB", section)
    assert total is not None
    own = sum(int(size) for name, _, size in rows if not name.startswith("`"))
    assert abs(own - int(total.group(1))) <= 4  # each is rounded
