"""Outputs are compiled while others are verified, and told in their order all the same."""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from tests.support.solving import FIXTURES

from ikgen.errors import VerificationError
from ikgen.generation import emitted_checks
from ikgen.generation.generate import generate
from ikgen.generation.request import Outputs, Request
from ikgen.generation.runners_ahead import RunnersAhead


class Fake:
    """A runner that notes what happens to it."""

    def __init__(self, name: str, log: list[str]) -> None:
        self.name, self.log = name, log
        log.append(f"make {name}")

    @property
    def constants(self) -> str:
        self.log.append(f"ask {self.name}")
        return self.name

    def close(self) -> None:
        self.log.append(f"close {self.name}")


def fakes(log: list[str], names: str) -> list[Callable[[], Any]]:
    return [lambda name=name: Fake(name, log) for name in names]


def test_the_next_is_made_before_one_is_used() -> None:
    log: list[str] = []
    with RunnersAhead(fakes(log, "abc")) as runners:
        for name in "abc":
            assert runners.take().name == name
            log.append(f"use {name}")
    made = ["make a", "make b", "ask a", "use a", "make c", "ask b", "use b", "ask c", "use c"]
    assert log == [*made, "close c", "close b", "close a"]


def test_what_making_one_raises_is_told_in_its_turn() -> None:
    def fail() -> None:
        raise VerificationError("not made")

    log: list[str] = []
    with RunnersAhead([*fakes(log, "a"), fail, lambda: None, *fakes(log, "b")]) as runners:
        assert runners.take().name == "a"
        with pytest.raises(VerificationError, match="not made"):
            runners.take()
        assert runners.take() is None
        assert runners.take().name == "b"


def test_those_that_were_not_taken_are_closed_too() -> None:
    log: list[str] = []
    with pytest.raises(KeyboardInterrupt), RunnersAhead(fakes(log, "abc")) as runners:
        runners.take()
        raise KeyboardInterrupt
    assert log == ["make a", "make b", "ask a", "close b", "close a"]


@pytest.mark.skipif(os.name == "nt", reason="needs sh")
@pytest.mark.parametrize("kind", [KeyboardInterrupt, VerificationError])
def test_a_compiler_ends_with_a_verification_that_does(
    kind: type[BaseException], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    scratch, started, late = (tmp_path / name for name in ("scratch", "started", "late"))
    scratch.mkdir()
    compiler = tmp_path / "compiler"
    compiler.write_text(f"#!/bin/sh\ntouch {started}; sleep 1; touch {late}\n")
    compiler.chmod(0o755)
    monkeypatch.setenv("CXX", str(compiler))
    monkeypatch.setattr(tempfile, "tempdir", str(scratch))

    def fail(*_: object, **__: object) -> None:
        while not started.exists():
            time.sleep(0.01)
        raise kind("wrong")

    monkeypatch.setattr(emitted_checks, "verify_one", fail)
    request = Request(FIXTURES / "kuka_kr6r900sixx.urdf")
    with pytest.raises(kind):
        generate(request, Outputs(out=tmp_path / "out", emit=("python", "cpp")))
    assert not list(scratch.iterdir()) and not (tmp_path / "out").exists()
    time.sleep(1.2)
    assert not late.exists()
