"""Fenced blocks of a Markdown page: files to write, commands to run, output to expect.

A comment just before a block says what its test does otherwise than to run it:

    <!-- not run: REASON -->                  the block is left out, and the output that follows it
    <!-- run without "TEXT": REASON -->       TEXT is left out of the block
    <!-- needs PROGRAM ... -->                left out where a program is not on PATH,
                                              or pkg-config:PACKAGE not known

and one anywhere says of the page:

    <!-- page not run: REASON -->             all of its blocks are left out
    <!-- page with FILE from PLACE -->        a file of the repository that the page takes for granted
    <!-- page after OTHER -->                 it goes on in the folder of another page
    <!-- page long -->                        it is run with `-m long` alone

Output may leave lines out. It is compared to the letter but for seconds (`1.9 s`), numbers with an exponent
(`3.0e-15`), and the version in `ikgen 0.1.0`, which differ from run to run and from machine to machine.
"""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

__all__ = ["Block", "blocks", "differing", "follow", "page_marks"]

_FENCE = re.compile(
    r"(?:^<!-- (?!page )(?P<mark>[^\n]*?) -->\n(?:<!-- page [^\n]*\n)*\n?)?"
    r'^```(?P<language>\w*)(?: title="(?P<title>[^"]*)")?\n(?P<text>.*?)^```$',
    re.M | re.S,
)
_PAGE_MARK = re.compile(r"<!-- page (not run: .+|with \S+ from \S+|after \S+|long) -->")
_COMMANDS = ("sh", "console")
_VARIES = (
    (re.compile(r"\d+(\.\d+)?(?= s\b)"), "#"),
    (re.compile(r"\d(\.\d+)?e[-+]\d+"), "#e#"),
    (re.compile(r"(?<=\bikgen )\d+(\.\d+)+\S*"), "#"),
)


@dataclass(frozen=True, slots=True)
class Block:
    """One fenced block: its language, its title ("" where it has none), its text, the comment before."""

    language: str
    title: str
    text: str
    mark: str = ""

    @property
    def is_file(self) -> bool:
        """Whether the title is the file that the text belongs in."""
        return "/" in self.title or "." in self.title

    @property
    def command(self) -> str:
        """What is typed; "" where the mark leaves it out."""
        if self.language == "console":
            lines = [x[2:] for x in self.text.splitlines() if x.startswith("$ ")]
            text = "\n".join(lines)
        else:
            text = self.text
        kind, _, rest = self.mark.partition(" ")
        if not self.mark:
            return text
        if self.mark.startswith("not run: "):
            return ""
        if kind == "needs":
            return text if all(map(_is_there, rest.split())) else ""
        without = re.fullmatch(r'run without "(.+)": .+', self.mark)
        assert without is not None, f"what is <!-- {self.mark} -->?"
        assert without[1] in text, f"{without[1]!r} is not in\n{text}"
        return text.replace(without[1], "", 1)


def blocks(page: Path) -> list[Block]:
    """All fenced blocks of a page in order."""
    text = page.read_text(encoding="utf-8")
    found = [
        Block(m["language"], m["title"] or "", m["text"], m["mark"] or "")
        for m in _FENCE.finditer(text)
    ]
    fences = re.findall(r"^\s*```", text, re.M)
    assert len(fences) == 2 * len(found), f"{page}: a fence that is not understood"
    return found


def page_marks(page: Path) -> list[str]:
    """What the page's own comments say."""
    return _PAGE_MARK.findall(page.read_text(encoding="utf-8"))


def follow(page: Path, folder: Path, root: Path) -> None:
    """Do in `folder` what the page says. `root` is the repository."""
    for mark in page_marks(page):
        if mark.startswith("with "):
            _, name, _, place = mark.split()
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(root / place, folder / name)
    output: str | None = None
    for block in blocks(page):
        if block.is_file:
            (folder / block.title).parent.mkdir(parents=True, exist_ok=True)
            (folder / block.title).write_text(block.text, encoding="utf-8")
        elif block.language in _COMMANDS:
            output = _run(block.command, folder) if block.command else None
        elif block.language == "text" and output is not None:
            missing = differing(block.text, output)
            assert not missing, f"{page.name}: {missing!r} is not in its place in\n{output}"


def differing(shown: str, printed: str) -> str:
    """The first line of a page's output that the program did not print after those before it; "" where
    all are there in their order."""
    rest = iter([_plain(line) for line in printed.splitlines()])
    for line in shown.splitlines():
        if line.strip() and _plain(line) not in rest:
            return line
    return ""


def _is_there(name: str) -> bool:
    """Whether a program is on PATH, or pkg-config knows a package."""
    kind, colon, package = name.rpartition(":")
    if not colon:
        return shutil.which(name) is not None
    command = [kind, "--exists", package]
    return shutil.which(kind) is not None and subprocess.run(command).returncode == 0


def _plain(text: str) -> str:
    """A line without what differs from run to run."""
    for pattern, word in _VARIES:
        text = pattern.sub(word, text)
    return text.rstrip()


def _run(command: str, folder: Path) -> str:
    """What commands print, errors and results in the order of a terminal."""
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        ["bash", "-euo", "pipefail", "-c", command],
        cwd=folder,
        env={**os.environ, "PATH": path, "COLUMNS": "120"},
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    )
    assert done.returncode == 0, f"{shlex.quote(command)}\n{done.stdout}"
    return done.stdout
