"""Emitted code of one arm, made by the command `ikgen` that is on the path.

Nothing here imports ikgen: whatever version `python -m ikgen` runs can be measured.
"""

from __future__ import annotations

import importlib.util
import itertools
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from types import ModuleType
from typing import Any

from benchmarks.collection import CORPUS, load_arms, urdf_of

__all__ = ["REPOSITORY", "Emitted", "Source", "emit", "load_module", "sources"]

REPOSITORY = Path(__file__).resolve().parents[1]
TABLES = REPOSITORY / "tests" / "robots" / "tables"
FIXTURES = REPOSITORY / "urdf_fixtures"
UNSOLVED = 3
_count = itertools.count()


@dataclass(frozen=True, slots=True)
class Source:
    """What to emit from: `key` names the arm among all, `family` its class; `choices` are options
    to try in turn until one gives a closed form. `row` is the arm of the collection that a URDF is
    written for, where there is no `file`."""

    key: str
    family: str
    file: Path | None
    links: tuple[str, ...] = ()
    choices: tuple[tuple[str, ...], ...] = ((),)
    row: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Emitted:
    """What came of it: the exit `code`, the processor time (s) of the run that gave it, the options it
    took, what the command printed, and the module and header where there are any."""

    source: Source
    code: int
    seconds: float
    options: tuple[str, ...]
    answer: dict[str, Any]
    module: Path | None = None
    header: Path | None = None

    @property
    def sizes(self) -> tuple[int, ...]:
        """Bytes of the module and of the header."""
        return tuple(p.stat().st_size for p in (self.module, self.header) if p is not None)


def sources(collections: Sequence[str] = ("fixtures", "suite", "corpus")) -> list[Source]:
    """The arms of the collections, by name: published files of this repository, tables of the IKBT
    suite, and the collection of robots where it is at hand."""
    out: list[Source] = []
    if "fixtures" in collections:
        files = [p for p in sorted(FIXTURES.glob("*.*")) if p.suffix in (".urdf", ".toml")]
        out += [Source(f"fixtures/{p.stem}", "fixtures", p) for p in files]
    if "suite" in collections:
        out += [Source(f"suite/{p.stem}", "suite", p) for p in sorted(TABLES.glob("*.toml"))]
    for arm in load_arms() if "corpus" in collections else ():
        out.append(
            Source(
                f"corpus/{arm['name']}", arm["family"],
                CORPUS / arm["file"] if arm.get("file") else None,
                ("--base", arm["base_link"], "--tip", arm["tip_link"]),
                row=arm,
            )
        )  # fmt: skip
    return out


def emit(source: Source, folder: Path, languages: str = "python,cpp", name: str = "arm") -> Emitted:
    """Generate without verification into `folder` (empty), with the first options that give a closed
    form."""
    file = source.file
    if file is None:
        file = folder / f"{source.row['name']}.urdf"
        file.write_text(urdf_of(source.row), encoding="utf-8")
    verb = "from-dh" if file.suffix == ".toml" else "from-urdf"
    code, seconds, options, answer = 2, 0.0, (), {}
    for options in source.choices:
        command = [
            sys.executable, "-m", "ikgen", verb, str(file), *source.links, *options,
            "--no-verify", "--emit", languages, "--name", name, "--json", "-q", "-o", str(folder),
        ]  # fmt: skip
        code, seconds, said = _run(command)
        answer = _answer(*said)
        if code != UNSOLVED:
            break
    paths = (folder / f"{name}_ik.py", folder / f"{name}_ik.hpp")
    made = [p if code == 0 and p.is_file() else None for p in paths]
    return Emitted(source, code, seconds, options, answer, *made)


def _run(command: Sequence[str]) -> tuple[int, float, tuple[str, str]]:
    """Exit code, seconds of processor time (the machine may be shared), stdout and stderr."""
    with tempfile.TemporaryFile("w+") as out, tempfile.TemporaryFile("w+") as err:
        process = subprocess.Popen(command, stdout=out, stderr=err, text=True)
        _, state, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(state)
        for file in (out, err):
            file.seek(0)
        return process.returncode, usage.ru_utime + usage.ru_stime, (out.read(), err.read())


def _answer(out: str, err: str) -> dict[str, Any]:
    try:
        return dict(json.loads(out))
    except ValueError:
        return {"error": " ".join(err.split())[:300]}


def load_module(path: Path) -> ModuleType:
    """An emitted module, under a name of its own."""
    name = f"emitted_{next(_count)}_ik"
    spec = importlib.util.spec_from_file_location(name, path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module
