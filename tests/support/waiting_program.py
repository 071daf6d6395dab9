"""A program that waits to be ended, and whether it was."""

from __future__ import annotations

import os
import time
from pathlib import Path

import pytest

__all__ = ["assert_ended", "script_of", "wait_until_started"]


def script_of(number: Path) -> str:
    """What sh is to run: write its number, then wait."""
    return f"echo $$ > {number}.new; mv {number}.new {number}; sleep 600"


def wait_until_started(number: Path) -> None:
    """Until the program has written its number."""
    while not number.exists():
        time.sleep(0.01)


def assert_ended(number: Path) -> None:
    """It runs no more and waits for nobody to ask how it ended."""
    with pytest.raises(ProcessLookupError):
        os.kill(int(number.read_text()), 0)
