"""Verification reports as JUnit XML: one suite per emitted module, one test case per check."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Iterable
from pathlib import Path

from ikgen.verify.verification_report import CheckResult, VerificationReport

__all__ = ["junit_xml", "write_junit_xml"]

_FORBIDDEN = {code: None for code in range(32) if chr(code) not in "\t\n\r"}


def _text(text: str) -> str:
    """Text without the control characters that XML 1.0 cannot hold."""
    return text.translate(_FORBIDDEN)


def _case(suite: ET.Element, name: str, check: CheckResult) -> None:
    case = ET.SubElement(suite, "testcase", classname=_text(name), name=check.name, time="0")
    summary = f"{check.failures} of {check.count} wrong"
    if not check.passed:
        message = "; ".join(part for part in (summary, check.numbers, check.detail) if part)
        failure = ET.SubElement(case, "failure", type=check.name, message=_text(message))
        failure.text = _text(check.worst_case)
    elif check.count == 0:
        ET.SubElement(case, "skipped", message=_text(check.detail or "nothing to check"))
    else:
        output = ET.SubElement(case, "system-out")
        output.text = _text("\n".join(filter(None, (summary, check.numbers, check.detail))))


def _suite(root: ET.Element, name: str, report: VerificationReport) -> None:
    skipped = sum(check.passed and check.count == 0 for check in report.checks)
    suite = ET.SubElement(
        root,
        "testsuite",
        name=_text(name),
        tests=str(len(report.checks)),
        failures=str(len(report.failed)),
        errors="0",
        skipped=str(skipped),
        time=f"{report.seconds:.3f}",
    )
    facts = {
        "base_link": report.base_link,
        "tip_link": report.tip_link,
        "task": report.task,
        "samples": str(report.samples),
        "seed": str(report.seed),
    }
    for band in report.bands:
        name_of = f"sigma {band.low:.0e} and more" if band.low else "sigma below the least edge"
        counts = f"{band.poses} poses, {band.missed} missed, {band.loose} loose"
        facts[name_of] = f"{counts}, {band.unanswered} without any row"
    properties = ET.SubElement(suite, "properties")
    for key, value in facts.items():
        ET.SubElement(properties, "property", name=key, value=_text(value))
    for check in report.checks:
        _case(suite, name, check)


def junit_xml(reports: Iterable[tuple[str, VerificationReport]]) -> str:
    """The XML text for (module name, report) pairs."""
    root = ET.Element("testsuites", name="ikgen verify")
    for name, report in reports:
        _suite(root, f"{name}.{report.label}", report)
    for count in ("tests", "failures", "skipped"):
        root.set(count, str(sum(int(suite.get(count, "0")) for suite in root)))
    ET.indent(root)
    return '<?xml version="1.0" encoding="utf-8"?>\n' + ET.tostring(root, encoding="unicode") + "\n"


def write_junit_xml(path: Path, reports: Iterable[tuple[str, VerificationReport]]) -> None:
    """Write `junit_xml` of the reports to `path` (UTF-8)."""
    path.write_text(junit_xml(reports), encoding="utf-8")
