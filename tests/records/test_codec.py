"""Tables become dataclasses and back; what does not fit is named by its place."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from ikgen.errors import shown
from ikgen.records.codec import CodecError, Decoder, encode, inlined, read_free, uncoded
from ikgen.records.request import Outputs, Request


@dataclass(frozen=True, slots=True)
class Inner:
    low: float
    names: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Outer:
    file: Path
    inner: Inner
    one: Inner = field(metadata=inlined())
    count: int = 1
    sure: bool = False
    table: Mapping[str, float | None] = field(default_factory=dict)
    word: str | None = None
    hidden: int = field(default=7, metadata=uncoded())


TABLE: dict[str, Any] = {
    "file": "a/b",
    "inner": {"low": 1, "names": ["x", "y"]},
    "low": 2.5,
    "count": 3,
    "table": {"j": None, "k": 2},
}


def test_there_and_back() -> None:
    found = Decoder(Path).table(Outer, TABLE, "outer")
    assert found == Outer(
        Path("a/b"), Inner(1.0, ("x", "y")), Inner(2.5), 3, table={"j": None, "k": 2.0}
    )
    assert isinstance(found.inner.low, float)
    plain = encode(found, Path.as_posix)
    assert plain == {**TABLE, "names": [], "sure": False, "word": None}
    assert Decoder(Path).table(Outer, json.loads(json.dumps(plain)), "outer") == found


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"file": 3}, "outer.file: 3 is not a string"),
        ({"count": 1.5}, "outer.count: 1.5 is not a number"),
        ({"count": True}, "outer.count: True is not a number"),
        ({"sure": 1}, "outer.sure: 1 is not a boolean"),
        ({"low": "x"}, "outer.low: 'x' is not a number"),
        ({"low": float("nan")}, "outer.low: nan is not a finite number"),
        ({"low": 10**400}, f"outer.low: {shown(10**400)} is not a finite number"),
        ({"inner": []}, "outer.inner is no table"),
        ({"inner": {}}, "outer.inner has no 'low'"),
        ({"inner": {"low": 0, "names": ["x", 1]}}, "outer.inner.names[1]: 1 is not a string"),
        ({"inner": {"low": 0, "names": "x"}}, "outer.inner.names: 'x' is not a list"),
        ({"table": {"j": "1"}}, "outer.table.j: '1' is not a number"),
        ({"table": 1}, "outer.table: 1 is not a table"),
        ({"hidden": 1}, "outer.hidden: unknown entry 'hidden'"),
        ({"inner": {"low": 0, "hihg": 1}}, "outer.inner.hihg: unknown entry 'hihg'"),
    ],
)
def test_what_does_not_fit(change: dict[str, Any], said: str) -> None:
    with pytest.raises(CodecError) as caught:
        Decoder(Path, strict=True).table(Outer, {**TABLE, **change}, "outer")
    assert str(caught.value) == said and caught.value.hint


def test_unknown_entries_are_passed_over_unless_strict() -> None:
    assert Decoder(Path).table(Inner, {"low": 1, "new": 2}, "inner") == Inner(1.0)


names = st.text("aZ_ .:=\"'\\\n\u00e9\u65e5\U0001f9be", max_size=4)
numbers = st.floats(allow_nan=False, allow_infinity=False)
requests = st.builds(
    Request,
    robot=st.just(Path("robot.urdf")),
    base=st.none() | names,
    free=st.dictionaries(names, st.none() | numbers),
    lock=st.dictionaries(names, numbers),
    args=st.dictionaries(names, names),
    package_paths=st.lists(st.just(Path("over/there")), max_size=2).map(tuple),
    name=st.none() | st.just("arm"),
)


@settings(deadline=None, suppress_health_check=[HealthCheck.too_slow])  # machines may be busy
@given(requests)
def test_requests_survive_json(request: Request) -> None:
    text = json.dumps(encode(request, Path.as_posix))
    assert Decoder(Path, strict=True).table(Request, json.loads(text), "arm[0]") == request


def test_a_list_of_held_joints_and_arguments_of_any_kind() -> None:
    table = {"robot": "r", "free": ["a", "b"], "args": {"mass": 2, "gripper": True}}
    found = Decoder(Path).table(Request, table, "arm[0]")
    assert found.free == {"a": None, "b": None}
    assert found.args == {"mass": "2", "gripper": "true"}


def test_samples_are_positive() -> None:
    with pytest.raises(CodecError, match="0 is less than 1"):
        Decoder(Path).table(Outputs, {"samples": 0}, "arm[0]")


def test_held_joints_are_a_list_or_a_table() -> None:
    assert read_free(["a"], "free") == {"a": None} and read_free({"a": 1}, "free") == {"a": 1}
    with pytest.raises(CodecError, match=r"^free: 'a' is neither a list of joints nor a table"):
        read_free("a", "free")
