"""A copy of this tree in which one module at a time is changed, and its tests, run till one fails.

A change inside a function is tested in a fork of a process that has collected all tests, its function given
the changed code (`benchmarks/forked_tests.py`); any other in a process that imports ikgen anew.
"""

from __future__ import annotations

import contextlib
import json
import os
import resource
import shutil
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from benchmarks.code_mutations import CodeMutation
from benchmarks.command_line import REPOSITORY
from benchmarks.forked_tests import LATE, Failing, pytest_options
from benchmarks.forked_work import forked
from benchmarks.reached_functions import Reaching

__all__ = ["Tree"]

_NEEDED = (
    "src", "templates", "tests", "benchmarks", "urdf_fixtures", "examples", "docs", "hooks",
    "pyproject.toml", "README.md", "CHANGELOG.md",
)  # fmt: skip


class Tree:
    """A copy of this repository's files."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        ignored = shutil.ignore_patterns("__pycache__", "build")
        for name in _NEEDED:
            place = REPOSITORY / name
            if place.is_dir():
                shutil.copytree(place, folder / name, ignore=ignored, symlinks=True)
            else:
                shutil.copy2(place, folder / name)

    @contextlib.contextmanager
    def changed(self, path: str, mutation: CodeMutation) -> Iterator[None]:
        """The module with the change."""
        file = self.folder / "src" / "ikgen" / path
        text, was = file.read_bytes(), file.stat()
        shutil.rmtree(self.folder / "cache", ignore_errors=True)
        file.write_bytes(mutation.applied(text))
        try:
            yield
        finally:  # with its time, so that what Python compiled of it counts again
            file.write_bytes(text)
            os.utime(file, ns=(was.st_atime_ns, was.st_mtime_ns))

    def run_anew(self, tests: Mapping[str, float]) -> str:
        """The first test that fails in a process that imports ikgen anew, or how else it ended; nothing
        where all pass. tests: their times (s)."""

        def work(say: int) -> None:
            import pytest

            notes = Failing(list(tests), say)
            files = dict.fromkeys(test.split("::")[0] for test in tests)
            seconds = int(30.0 + LATE * sum(tests.values()))
            resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))
            code = int(pytest.main([*pytest_options(self.folder), "-x", *files], plugins=[notes]))
            os.write(
                say, (notes.failed or ("" if code in (0, 5) else f"exit code {code}")).encode()
            )

        return forked(work, 600.0 + 20.0 * sum(tests.values()), self.folder)

    def record(self, files: Sequence[str], to: Path) -> None:
        """Write what the tests of the files reach."""

        def work(say: int) -> None:
            import pytest

            notes = Reaching(self.folder / "src" / "ikgen", to)
            options = [*pytest_options(self.folder), "--continue-on-collection-errors"]
            pytest.main([*options, *files], plugins=[notes])

        forked(work, 7200.0, self.folder, keep=True)
        with to.open("a", encoding="utf-8") as stream:  # so that those without tests are known too
            for file in files:
                stream.write(
                    json.dumps({"test": f"{file}::", "seconds": 0.0, "functions": []}) + "\n"
                )
