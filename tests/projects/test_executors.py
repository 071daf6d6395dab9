"""Arms built and samples verified by whatever executor: the same outcome."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from ikgen.cli.main import run
from ikgen.projects import recheck, sample_blocks
from ikgen.projects.check_findings import Finding
from ikgen.verify.verification_report import CheckResult


def verified(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, *options: str
) -> dict[str, Any]:
    """What `ikgen verify` says of 50 samples in blocks of 20."""
    for module in (sample_blocks, recheck):
        monkeypatch.setattr(module, "BLOCK", 20)
    assert run(["verify", "first_ik.json", "--samples", "50", "--json", "-q", *options]) == 0
    found: dict[str, Any] = json.loads(capsys.readouterr().out)
    return found


def test_blocks_are_the_same_from_any_number_of_workers(
    project: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert run(["build", "-q", "--jobs", "1"]) == 0
    one = verified(capsys, monkeypatch, "--workers", "1")
    assert verified(capsys, monkeypatch, "--workers", "2") == one
    report = one["outputs"][0]["verification"]["python"]
    checks = {check["name"]: check for check in report["checks"]}
    assert report["samples"] == 50 and report["passed"]
    assert checks["forward"]["count"] == 50


def test_what_a_later_block_finds_is_found(
    project: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert run(["build", "-q", "--jobs", "1"]) == 0

    def wrong(workers: Any, work: Any, pieces: Any, done: Any) -> Any:
        *parts, last = [work(piece) for piece in pieces]
        bad = CheckResult("closure", False, 1, 1, worst_case="this one")
        finding = Finding(Path("first_ik.py"), "is wrong: this one", "")
        report = replace(last.reports["python"], checks=(bad,))
        return [*parts, replace(last, findings=(finding,), reports={"python": report})]

    monkeypatch.setattr(sample_blocks, "run_pieces", wrong)
    for module in (sample_blocks, recheck):
        monkeypatch.setattr(module, "BLOCK", 20)
    assert run(["verify", "first_ik.json", "--samples", "50", "--json", "-q"]) == 1
    output = json.loads(capsys.readouterr().out)["outputs"][0]
    checks = output["verification"]["python"]["checks"]
    closure = next(check for check in checks if check["name"] == "closure")
    assert not closure["passed"] and closure["worst_case"] == "this one"
    assert [f["message"] for f in output["findings"]] == ["is wrong: this one"]


def test_dask_builds_and_verifies(
    project: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("distributed")
    assert run(["build", "-q", "--executor", "dask", "--jobs", "2"]) == 0
    texts = [(project / f"{name}_ik.py").read_bytes() for name in ("first", "second")]
    assert run(["build", "-q", "--force", "--jobs", "2"]) == 0
    assert [(project / f"{name}_ik.py").read_bytes() for name in ("first", "second")] == texts
    one = verified(capsys, monkeypatch, "--workers", "1")
    assert verified(capsys, monkeypatch, "--executor", "dask", "--workers", "2") == one


def test_a_scheduler_needs_dask(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["build", "--scheduler", "tcp://127.0.0.1:1"]) == 2
    assert "--scheduler needs --executor dask" in capsys.readouterr().err
