"""Files under version control that a merge left half resolved, and texts that readers choke on."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from ikgen.errors import BadDescriptionError
from ikgen.importers.calibration import row_offsets
from ikgen.importers.dh.table_document import read_document
from ikgen.importers.merge_conflict import conflict_or
from ikgen.projects.config import load_config
from ikgen.records.record import find_records, read_record

READERS: dict[str, Callable[[Path], Any]] = {
    "ikgen.toml": load_config,
    "table.toml": read_document,
    "own.toml": lambda path: row_offsets(path, 2),
    "arm_ik.json": read_record,
}
CONFLICT = 'name = "a"\n<<<<<<< HEAD\nx = 1\n=======\nx = 2\n>>>>>>> other\n'
BEYOND = {"deep": "x = " + "[" * 100_000, "long": "x = " + "9" * 10_000}


def test_only_markers_are_a_conflict() -> None:
    assert "unresolved merge conflict" in conflict_or(CONFLICT, "else")
    assert conflict_or("a <<<<<<< b\n=======\n<<<<<<<<\n", "else") == "else"


@pytest.mark.parametrize("name", READERS)
def test_a_conflict_is_told(name: str, tmp_path: Path) -> None:
    (tmp_path / name).write_text(CONFLICT)
    with pytest.raises(BadDescriptionError) as caught:
        READERS[name](tmp_path / name)
    assert "unresolved merge conflict" in caught.value.hint
    assert name in caught.value.message


@pytest.mark.parametrize("name", READERS)
@pytest.mark.parametrize("kind", BEYOND)
def test_what_is_too_deep_or_too_long_is_refused(name: str, kind: str, tmp_path: Path) -> None:
    text = BEYOND[kind].removeprefix("x = ") if name.endswith(".json") else BEYOND[kind]
    (tmp_path / name).write_text(text)
    with pytest.raises(BadDescriptionError, match=name):
        READERS[name](tmp_path / name)


def test_a_record_too_deep_counts_as_one(tmp_path: Path) -> None:
    (tmp_path / "arm_ik.json").write_text("[" * 100_000)
    assert find_records(tmp_path) == [tmp_path / "arm_ik.json"]
