"""Bounds and steps of a method are the same numbers in both languages, where a file of each has it."""

from __future__ import annotations

import re
from pathlib import Path

import ikgen.runtime

RUNTIME = Path(ikgen.runtime.__file__).parent
PYTHON = re.compile(r"^_?([A-Z][A-Z0-9_]*)(?:: \w+)? = ([-\d.e]+)(?=\s)", re.MULTILINE)
CPP = re.compile(r"constexpr (?:double|int) k(\w+) = ([-\d.e]+);")

OTHERWISE = {
    ("curve_samples", "near"): "slopes along the curve are taken in C++ alone: they need it nearer",
}
"""By file and name, what differs, and why."""


def numbers(path: Path, pattern: re.Pattern[str]) -> dict[str, float]:
    found = pattern.findall(path.read_text())
    return {name.replace("_", "").lower(): float(value) for name, value in found}


def test_they_are_the_same() -> None:
    compared = 0
    for path in sorted((RUNTIME / "python").rglob("*.py")):
        other = RUNTIME / "cpp" / path.relative_to(RUNTIME / "python").with_suffix(".hpp")
        if not other.is_file():
            continue
        one, two = numbers(path, PYTHON), numbers(other, CPP)
        for name in one.keys() & two.keys():
            compared += 1
            differs = (path.stem, name) in OTHERWISE
            assert (one[name] != two[name]) == differs, (path.stem, name, one[name], two[name])
    assert compared > 25
