"""The table by class, and a baseline that is right."""

from __future__ import annotations

import platform
from pathlib import Path

import pytest
from benchmarks.command_line import REPOSITORY, Source
from benchmarks.cpp_speed import FLAGS
from benchmarks.results import read_result
from benchmarks.speed_by_class import RECORDS, Timed, by_class, instructions, table, time_arm
from tests.support.solving import NO_COMPILER


def test_the_table_has_a_line_a_class_and_one_of_all() -> None:
    timed = [
        Timed(f"a{n}", f"class {n % 2}", 100.0 * (n + 1), 50.0, 400.0, 0.25 * (n + 1), 8.0)
        for n in range(3)
    ]
    lines = list(table(timed))
    assert lines[1].split()[-6:] == ["2", "200", "300", "50", "0.50", "0.75"]
    assert lines[2].split()[-6:] == ["1", "200", "200", "50", "0.50", "0.50"]
    assert lines[3].split() == ["all", "3", "200", "300", "50", "0.50", "0.75"]
    assert [(c.family, c.worst) for c in by_class(timed)] == [
        ("class 0", "a2"), ("class 1", "a1"), ("all", "a2"),
    ]  # fmt: skip


@pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER or "")
@pytest.mark.skipif(platform.machine() not in ("x86_64", "AMD64"), reason="other instructions")
def test_instructions_are_those_that_the_flags_allow() -> None:
    assert [instructions(flags) for flags in ([], FLAGS["avx2"])] == ["SSE2", "AVX2"]


@pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER or "")
def test_a_header_is_timed_beside_a_baseline_that_is_right() -> None:
    arm = Source("irb2400", "some", REPOSITORY / "urdf_fixtures" / "abb_irb2400.urdf")
    found = time_arm(arm, ["-O1"])
    assert isinstance(found, Timed)
    assert found.rows > 4.0 and found.single > 0.0 and found.baseline > 0.0
    assert isinstance(time_arm(Source("none", "", Path("nowhere.urdf")), ["-O1"]), str)


def test_records_of_machines_with_wide_vectors_and_without_stand_side_by_side() -> None:
    wide, narrow = (read_result(name) for name in RECORDS.values())
    assert [wide.found["instructions"], narrow.found["instructions"]] == list(RECORDS)
    assert [c["family"] for c in wide.found["classes"]] == [
        c["family"] for c in narrow.found["classes"]
    ]
