"""Reports of a module's samples in several blocks, as one."""

from __future__ import annotations

from dataclasses import replace

from ikgen.verify.merged_reports import merged_reports
from ikgen.verify.verification_report import CheckResult, SigmaBand, VerificationReport


def test_merged_reports_add_up() -> None:
    good = CheckResult("closure", True, 10, 0, (("m", 1e-9), ("rad", 3e-9)), "all")
    bad = CheckResult("closure", False, 5, 2, (("m", 4e-3), ("rad", 1e-9)), "two", "here")
    one = VerificationReport(
        "python", "a", "b", "pose", 10, 0, (good,), ((2, 4), (8, 6)), seconds=1.0,
        bands=(SigmaBand(0.0, 0.1, 3, 1, 4, 5, "near"), SigmaBand(0.1, 1.0, 7, 0, 1, 2)),
        by_default=(3, 10),
    )  # fmt: skip
    two = replace(
        one,
        samples=5,
        checks=(bad,),
        histogram=((8, 5),),
        bands=(SigmaBand(0.1, 1.0, 5, 2, 6, 7, "far"),),
        by_default=(2, 5),
    )
    both = merged_reports([one, two])
    assert both.samples == 15 and both.histogram == ((2, 4), (8, 11)) and both.seconds == 2.0
    assert both.checks == (
        CheckResult("closure", False, 15, 2, (("m", 4e-3), ("rad", 3e-9)), "two", "here"),
    )
    assert both.bands == (
        SigmaBand(0.0, 0.1, 3, 1, 4, 5, "near"), SigmaBand(0.1, 1.0, 12, 2, 7, 9, "far"),
    )  # fmt: skip
    assert both.by_default == (5, 15)
    assert merged_reports([one]) == one
