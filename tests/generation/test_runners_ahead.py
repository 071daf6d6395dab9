"""Outputs are compiled while others are verified, and told in their order all the same."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from tests.support.solving import FIXTURES
from tests.support.waiting_program import assert_ended, compiler_of, script_of, wait_until_started

from ikgen.derivation.read import read
from ikgen.errors import BadDescriptionError, VerificationError
from ikgen.generation import emitted_checks
from ikgen.generation.emitters import Emitter, find_emitter
from ikgen.generation.generate import generate, make_texts
from ikgen.generation.runners_ahead import RunnersAhead
from ikgen.records.request import Outputs, Request

pytestmark = pytest.mark.usefixtures("solved_once")


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


def test_one_is_made_before_the_others_and_taken_in_its_turn() -> None:
    log: list[str] = []
    with RunnersAhead(fakes(log, "abc"), 1) as runners:
        assert [runners.take().name for _ in "abc"] == ["a", "b", "c"]
    assert log[:5] == ["make b", "make a", "ask a", "make c", "ask b"]


def test_what_was_made_is_closed_where_making_another_is_interrupted() -> None:
    def interrupted() -> None:
        raise KeyboardInterrupt

    log: list[str] = []
    with pytest.raises(KeyboardInterrupt), RunnersAhead([interrupted, *fakes(log, "b")], 1):
        pass
    assert log == ["make b", "close b"]


@pytest.mark.parametrize("names", [("python", "sympy", "cpp"), ("cpp", "sympy", "python")])
def test_the_header_is_compiled_while_the_module_is_verified_and_told_where_it_was_asked_for(
    names: tuple[str, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    steps: list[str] = []

    def noted(emitter: Emitter, *_: object) -> dict[str, str]:
        steps.append(emitter.name)
        return {f"{emitter.name}.txt": ""}

    class Runner:
        constants = None

        def __init__(self, name: str) -> None:
            self.name = name

    def verified(runner: Runner, *_: object, peer: Runner | None, **more: object) -> object:
        steps.append(f"verify {runner.name}" + (f" with {peer.name}" if peer else ""))
        return SimpleNamespace(passed=True)

    monkeypatch.setattr(Emitter, "emit", noted)
    monkeypatch.setattr(Emitter, "runner", lambda self, *_: Runner(self.name))
    monkeypatch.setattr(emitted_checks, "verify_one", verified)
    request = Request(FIXTURES / "kuka_kr6r900sixx.urdf")
    emitters = [find_emitter(name) for name in names]
    made = make_texts(request, read(request), emitters, Outputs(out=tmp_path))
    assert steps == ["sympy", "cpp", "python", "verify python", "verify cpp with python"]
    assert list(made.texts) == list(names)
    assert list(made.reports) == [name for name in names if name != "sympy"]


@pytest.mark.parametrize("where", ["emit", "runner"])
def test_an_output_that_cannot_be_emitted_is_not_one_that_cannot_be_run(
    where: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise BadDescriptionError("has none")

    monkeypatch.setattr(Emitter, where, fail)
    kind = BadDescriptionError if where == "emit" else VerificationError
    with pytest.raises(kind, match="has none"):
        generate(Request(FIXTURES / "kuka_kr6r900sixx.urdf"), Outputs(out=tmp_path / "out"))
    assert not (tmp_path / "out").exists()


@pytest.mark.skipif(os.name == "nt", reason="needs sh")
@pytest.mark.parametrize("kind", [KeyboardInterrupt, VerificationError])
def test_a_compiler_ends_with_a_verification_that_does(
    kind: type[BaseException], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    scratch, number = tmp_path / "scratch", tmp_path / "number"
    scratch.mkdir()
    monkeypatch.setenv("CXX", compiler_of(tmp_path, script_of(number)))
    monkeypatch.setattr(tempfile, "tempdir", str(scratch))

    def fail(*_: object, **__: object) -> None:
        wait_until_started(number)
        raise kind("wrong")

    monkeypatch.setattr(emitted_checks, "verify_one", fail)
    request = Request(FIXTURES / "kuka_kr6r900sixx.urdf")
    with pytest.raises(kind):
        generate(request, Outputs(out=tmp_path / "out", emit=("python", "cpp")))
    assert not list(scratch.iterdir()) and not (tmp_path / "out").exists()
    assert_ended(number)
