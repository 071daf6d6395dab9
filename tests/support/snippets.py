"""Fenced blocks of a Markdown page: files to write, commands to run, output to expect."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

__all__ = ["Block", "blocks", "follow"]

_FENCE = re.compile(r"^```(\w+)(?: title=\"([^\"]+)\")?\n(.*?)^```$", re.M | re.S)
_NUMBER = re.compile(r"\d[\d.]*(e[+-]?\d+)?")


@dataclass(frozen=True)
class Block:
    """`title` is the name of the file that the block is ("": none)."""

    language: str
    title: str
    text: str


def blocks(page: Path) -> Iterator[Block]:
    """The page's blocks in order."""
    for language, title, text in _FENCE.findall(page.read_text(encoding="utf-8")):
        yield Block(language, title, text)


def follow(page: Path, folder: Path) -> int:
    """Do in `folder` what the page says; how many commands ran.

    Blocks with a title are files, `sh` is run, and lines of `text` must be lines of the output of the
    last command; numbers do not count in lines with a colon, which are those that ikgen prints.
    """
    output, ran = "", 0
    for block in blocks(page):
        if block.title:
            (folder / block.title).write_text(block.text, encoding="utf-8")
        elif block.language == "sh":
            output, ran = _run(block.text, folder), ran + 1
        elif block.language == "text":
            printed = [_plain(line) for line in output.splitlines()]
            for line in map(_plain, block.text.splitlines()):
                assert line in printed, f"{page.name}: {line!r} not in\n{output}"
    return ran


def _plain(text: str) -> str:
    """A line without the numbers that differ from run to run or from machine to machine."""
    return _NUMBER.sub("#", text) if ":" in text else text


def _run(command: str, folder: Path) -> str:
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        ["bash", "-euc", command],
        cwd=folder,
        env={**os.environ, "PATH": path},
        text=True,
        capture_output=True,
    )
    assert done.returncode == 0, f"{command}\n{done.stdout}{done.stderr}"
    return done.stdout
