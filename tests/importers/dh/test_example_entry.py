"""`example` in a DH table: joint values for the report, or an error that says what to write."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from ikgen.errors import BadDescriptionError
from ikgen.importers.dh.dh_table import read_dh_table

TABLE = """
name = "two"
convention = "modified"
{example}
[parameters]
l = 0.5
[[joints]]
type = "revolute"
alpha = 0
a = 0
d = 0
theta = 0
[[joints]]
type = "prismatic"
alpha = "pi/2"
a = "l"
d = 0
theta = 0
"""


def read(folder: Path, example: str, **options: dict[str, float]) -> tuple[float, ...]:
    path = folder / "two.toml"
    path.write_text(TABLE.format(example=example))
    return read_dh_table(path, **options)[0].example


def test_values_and_expressions(tmp_path: Path) -> None:
    assert read(tmp_path, 'example = ["pi/6", 0.25]') == (math.pi / 6, 0.25)
    assert read(tmp_path, 'example = [1, "l"]') == (1.0, 0.5)
    assert read(tmp_path, "") == ()


def test_a_locked_joint_has_none(tmp_path: Path) -> None:
    assert read(tmp_path, "example = [0.5, 0.25]", locked={"theta_1": 0.1}) == (0.25,)


@pytest.mark.parametrize(
    ("entry", "words"),
    [
        ("example = [1]", "is no list of 2 joint values"),
        ("example = 3", "is no list of 2 joint values"),
        ("example = [1, true]", "no number"),
        ('example = [1, "wrong("]', "wrong("),
        ('example = [1, "m"]', "no number"),
        ("example = [1, inf]", "inf"),
    ],
)
def test_what_is_wrong_is_said_with_its_line(tmp_path: Path, entry: str, words: str) -> None:
    with pytest.raises(BadDescriptionError, match="example") as caught:
        read(tmp_path, entry)
    assert words in str(caught.value) and caught.value.line == 4
    assert "example = [0.5" in caught.value.hint
