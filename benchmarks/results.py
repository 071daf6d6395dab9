"""Recorded results of benchmark commands, which the README's figures come from."""

from __future__ import annotations

import datetime
import json
import os
import platform
import subprocess
from collections import Counter
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

__all__ = ["FOLDER", "Measured", "added_counts", "commit", "read_result", "write_result"]

FOLDER = Path(__file__).resolve().parent / "results"


@dataclass(frozen=True, slots=True)
class Measured:
    """One recorded run: the command that gave it, the commit (with a plus sign where the tree had changes
    beside it), the date, the machine, and what was found."""

    command: str
    commit: str
    date: str
    machine: str
    found: dict[str, Any]


def write_result(name: str, command: str, found: dict[str, Any]) -> Path:
    """Write `results/<name>.json`, marked with the commit and the date."""
    machine = f"{os.cpu_count()} cores, {platform.machine()}"
    measured = Measured(command, commit(), datetime.date.today().isoformat(), machine, found)
    FOLDER.mkdir(exist_ok=True)
    path = FOLDER / f"{name}.json"
    path.write_text(json.dumps(asdict(measured), indent=1) + "\n", encoding="utf-8")
    return path


def read_result(name: str) -> Measured:
    """A recorded run; raises `FileNotFoundError` where there is none."""
    return Measured(**json.loads((FOLDER / f"{name}.json").read_text(encoding="utf-8")))


def added_counts(name: str, key: str, counts: Mapping[str, int]) -> dict[str, int]:
    """Counts together with those recorded of this very commit under `key`, of runs with other seeds."""
    try:
        earlier = read_result(name)
    except FileNotFoundError:
        return dict(counts)
    before = earlier.found[key] if earlier.commit == commit() else {}
    return dict(Counter(before) + Counter(counts))


def commit() -> str:
    """The commit that is checked out, as short as it may be; "unknown" outside a repository."""

    def git(*arguments: str) -> str:
        command = ["git", "-C", str(FOLDER.parent), *arguments]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        return done.stdout.strip() if done.returncode == 0 else ""

    changed = git("status", "--porcelain", "--untracked-files=no", "--", "../src", "../templates")
    return (git("rev-parse", "--short=7", "HEAD") or "unknown") + ("+" if changed else "")
