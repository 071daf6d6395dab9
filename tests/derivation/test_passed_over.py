"""What is said where the task that fits an arm best gives code that fails its verification."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from tests.support.solving import FIXTURES

from ikgen.cli.summary_text import summary
from ikgen.derivation.advice import attempts
from ikgen.derivation.progress import silent
from ikgen.derivation.read import read
from ikgen.emit.derivation import Derivation
from ikgen.errors import VerificationError
from ikgen.generation.generate import generate
from ikgen.generation.result import as_dict
from ikgen.records.request import Outputs, Request

FIVE_JOINTS = Request(FIXTURES / "igus_robolink_rl_dp_5.urdf")


def test_tasks_that_failed_are_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[str] = []

    def emitted(derivation: Derivation, *_: object) -> tuple[dict[str, dict[str, str]], object]:
        seen.append(derivation.task.name)
        if len(seen) == 1:
            raise VerificationError("wrong")
        return {}, {}

    monkeypatch.setattr("ikgen.generation.generate._emitted", emitted)
    made = generate(FIVE_JOINTS, Outputs(out=tmp_path))
    first, second = seen
    told = as_dict(made)
    assert first != second and told["chosen"] == {"task": second, "passed_over": [first]}
    (warning,) = (text for text in told["warnings"] if "failed its verification" in text)
    assert f"'{first}'" in warning and f"'{second}'" in warning
    assert f"failed verification: {first}" in summary(made)


def test_what_holds_a_joint_that_the_task_needs_is_told_with_the_result(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("ikgen.generation.generate._emitted", lambda *_: ({}, {}))
    held = replace(FIVE_JOINTS, task="pose")
    made = generate(held, Outputs(out=tmp_path))
    assert "OVER-CONSTRAINED" in summary(made)
    assert "OVER-CONSTRAINED" not in summary(generate(FIVE_JOINTS, Outputs(out=tmp_path / "other")))


def test_attempt_without_options_is_the_task_that_is_taken() -> None:
    reading = read(FIVE_JOINTS)
    (default,) = (one for one in attempts(reading, None, silent) if one.default)
    assert default.task == "position-direction"
    assert not any(one.default for one in attempts(reading, default.task, silent))
