"""Reports: what passes, what is rendered, and their JUnit XML."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import pytest
from junitparser import JUnitXml

from ikgen.verify.junit import write_junit_xml
from ikgen.verify.verification_report import CheckResult, SigmaBand, VerificationReport

GOOD = CheckResult("closure", True, 800, worst=(("position m", 1e-15), ("rotation rad", 2e-15)))
IDLE = CheckResult("free joints", True, 0, detail="no joint is held free")
BAD = CheckResult(
    "completeness", False, 100, 3, (("off rad or m", math.inf),), "so & <so>\x1b",
    "random #7: q = [0]",
)  # fmt: skip


def report(*checks: CheckResult, label: str = "python") -> VerificationReport:
    """A report with these checks."""
    return VerificationReport(label, "b", "t", "pose", 100, 0, checks, ((4, 25), (8, 75)))


def test_verdict() -> None:
    assert report(GOOD, IDLE).passed
    assert not report(GOOD, BAD).passed
    assert not report().passed
    assert report(GOOD, BAD).failed == (BAD,)
    with pytest.raises(KeyError):
        report(GOOD).check("determinism")


def test_numbers_and_text() -> None:
    both = report(GOOD, BAD)
    assert both.worst_closure == (1e-15, 2e-15)
    assert both.solutions == (4, 7.0, 8)
    assert "3 of 100 wrong" in both.worst_case and "random #7" in both.worst_case
    assert both.table()[1][:3] == ("completeness", "FAILED", "100")
    data = both.to_dict()
    assert data["checks"][1]["worst"] == {"off rad or m": None}
    assert data["passed"] is False and "seconds" not in data
    assert data["by_default"] is None
    held = replace(both, by_default=(43, 100)).to_dict()
    assert held["by_default"] == {"answered": 43, "poses": 100}


def test_misses_are_said_to_be_near_singularities_where_all_are() -> None:
    bands = (
        SigmaBand(0.0, 1e-3, 40, missed=2), SigmaBand(1e-3, 1e-2, 30, missed=1),
        SigmaBand(1e-2, math.inf, 900),
    )  # fmt: skip
    near = replace(report(GOOD), bands=bands)
    assert near.missed == 3
    assert near.missed_words == "3 missed, all of them among 70 poses near singularities"
    silent = replace(near, bands=(replace(bands[0], unanswered=1), *bands[1:]))
    assert silent.missed_words == f"{near.missed_words}, 1 without a row"
    searched = CheckResult("exhaustive search", False, 100, 4)
    failed = replace(report(GOOD, searched), bands=bands)
    assert failed.missed == 7 and failed.missed_words == "7 missed"
    for none in (report(GOOD), report(GOOD, BAD), replace(report(GOOD), bands=bands[2:])):
        assert none.missed == 0 and none.missed_words == "0 missed"
    assert [band["high"] for band in near.to_dict()["by_sigma"]] == [1e-3, 1e-2, None]


def test_junit(tmp_path: Path) -> None:
    path = tmp_path / "out.xml"
    write_junit_xml(path, [("ur5e", report(GOOD, IDLE, BAD)), ("ur5e", report(GOOD, label="cpp"))])
    suites = JUnitXml.fromfile(str(path))
    assert [suite.name for suite in suites] == ["ur5e.python", "ur5e.cpp"]
    assert (suites.tests, suites.failures, suites.skipped) == (4, 1, 1)
    first, *_ = suites
    cases = {case.name: case for case in first}
    assert cases["closure"].is_passed and cases["free joints"].is_skipped
    assert cases["free joints"].result[0].message == "no joint is held free"
    write_junit_xml(path, [("ur5e", report(replace(IDLE, detail="")))])
    ((plain,),) = JUnitXml.fromfile(str(path))
    assert plain.result[0].message == "nothing to check"
    assert cases["completeness"].is_failure
    assert "3 of 100" in cases["completeness"].result[0].message
    assert "random #7" in cases["completeness"].result[0].text
