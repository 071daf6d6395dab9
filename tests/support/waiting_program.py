"""A program that waits to be ended, and whether it was; compilers that do as told."""

from __future__ import annotations

import os
import time
from pathlib import Path

import pytest

__all__ = ["assert_ended", "compiler_of", "script_of", "wait_until_started"]


def script_of(number: Path) -> str:
    """What sh is to run: write its number, then wait."""
    return f"echo $$ > {number}.new; mv {number}.new {number}; sleep 600"


def compiler_of(folder: Path, script: str) -> str:
    """A compiler that does what sh makes of the script, but when asked for its version: its command."""
    path = folder / "compiler"
    path.write_text(f'#!/bin/sh\n[ "$1" = -v ] && exit\n{script}\n')
    path.chmod(0o755)
    return str(path)


def wait_until_started(number: Path) -> None:
    """Until the program has written its number."""
    while not number.exists():
        time.sleep(0.01)


def assert_ended(number: Path) -> None:
    """It runs no more and waits for nobody to ask how it ended."""
    with pytest.raises(ProcessLookupError):
        os.kill(int(number.read_text()), 0)
