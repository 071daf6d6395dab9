"""Bounds and steps of a method are the same numbers in both languages, where a file of each has it."""

from __future__ import annotations

import re
from pathlib import Path

import ikgen.runtime
from ikgen.program.policy import SolvePolicy

RUNTIME = Path(ikgen.runtime.__file__).parent
PYTHON = re.compile(r"^_?([A-Z][A-Z0-9_]*)(?:: \w+)? = ([-\d.e]+)(?=\s)", re.MULTILINE)
CPP = re.compile(r"constexpr (?:double|int) k(\w+) = ([-\d.e]+);")

OTHERWISE = {
    ("curve_samples", "near"): "slopes along the curve are taken in C++ alone: they need it nearer",
}
"""By file and name, what differs, and why."""

ALSO = {
    "arm/limit_margins": ("arm/joint_bounds",),
    "arm/task_interface": ("arrays/constants",),
    "elimination/general_6r": ("elimination/general_6r_runs",),
    "elimination/hidden_angle": ("elimination/general_6r_spectrum",),
    "held/branch_arcs": ("held/branch_arc",),
    "held/held_grid_search": ("held/lone_value",),
    "held/solution_search": ("held/seeds_row", "held/values_descent"),
    "roots/quartic_lines": ("roots/trig_quartic",),
    "roots/trig_polynomial_numbers": ("roots/trig_polynomial",),
    "roots/trig_quartic_roots": ("roots/trig_quartic",),
    "rows/row_links": ("held/branch_links",),
    "rows/solution_rows": ("elimination/general_6r_runs",),
    "singular/curve_crossings": ("singular/near_continuum",),
    "singular/curve_walks": ("singular/near_continuum",),
    "singular/limit_curves": ("singular/limit_curve",),
    "singular/meeting_rows": ("solving/row_starts",),
    "solving/pose_solving": ("solving/projection",),
    "solving/projection": ("solving/nearest_row",),
}
"""By file of Python the headers that have its method under another name, or a part of it."""


def numbers(path: Path, pattern: re.Pattern[str]) -> dict[str, float]:
    found = pattern.findall(path.read_text())
    return {name.replace("_", "").lower(): float(value) for name, value in found}


def test_they_are_the_same() -> None:
    compared = 0
    for path in sorted((RUNTIME / "python").rglob("*.py")):
        place = path.relative_to(RUNTIME / "python").with_suffix("").as_posix()
        for other in (place, *ALSO.get(place, ())):
            if not (header := RUNTIME / "cpp" / f"{other}.hpp").is_file():
                assert other == place, f"no header {other}"
                continue
            one, two = numbers(path, PYTHON), numbers(header, CPP)
            shared = one.keys() & two.keys()
            assert shared or other == place, f"{place} and {other} have no number in common"
            compared += len(shared)
            for name in shared:
                differs = (path.stem, name) in OTHERWISE
                assert (one[name] != two[name]) == differs, (other, name, one[name], two[name])
    assert compared >= 64


def test_eliminations_go_by_the_policy() -> None:
    found = numbers(RUNTIME / "cpp/elimination/general_6r_solutions.hpp", CPP)
    policy = SolvePolicy()
    assert found["coincidentrows"] == policy.coincident and found["verified"] == policy.arrived
