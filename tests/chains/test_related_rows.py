"""Joints of DH tables that follow others."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from ikgen.derivation.read import read
from ikgen.errors import UnknownNameError, UsageError
from ikgen.generation.emitted_checks import oracle_for
from ikgen.generation.generate import generate
from ikgen.records.request import Outputs, Request

TABLE = """
name = "stages"
convention = "modified"
[[joints]]
type = "revolute"
name = "turn"
alpha = 0
a = 0
d = 0.3
theta = 0
limits = [-3, 3]
[[joints]]
type = "revolute"
name = "tilt"
alpha = "pi/2"
a = 0.1
d = 0
theta = "pi/2"
limits = [-1, 2]
[[joints]]
type = "prismatic"
name = "reach"
alpha = "pi/2"
a = 0
d = 0
theta = 0
limits = [0, 0.5]
"""


@pytest.fixture
def table(tmp_path: Path) -> Path:
    path = tmp_path / "stages.toml"
    path.write_text(TABLE)
    return path


@pytest.mark.parametrize(("follower", "source"), [("tilt", "turn"), ("turn", "tilt")])
def test_the_follower_moves_with_its_source(table: Path, follower: str, source: str) -> None:
    related = read(Request(table, couple={follower: f"{source}*-2+0.25"}))
    whole = read(Request(table))
    assert [j.name for j in related.dh.joints] == [source, "reach"]
    values = {source: 0.3, follower: -2 * 0.3 + 0.25, "reach": 0.2}
    q = np.array([[values[j.name] for j in whole.dh.joints]])
    np.testing.assert_allclose(
        oracle_for(related).forward(np.array([[0.3, 0.2]])),
        oracle_for(whole).forward(q),
        atol=1e-15,
    )


@pytest.mark.parametrize("order", [("tilt", "turn"), ("turn", "tilt")])
def test_a_joint_follows_one_that_follows_another(tmp_path: Path, order: tuple[str, ...]) -> None:
    """Whichever relation is given first; the limits of the last are those of the first too."""
    path = tmp_path / "four.toml"
    more = TABLE.replace('"turn"', '"lead"').replace("[-3, 3]", "[-2.5, 3]").split("[[joints]]")[1]
    path.write_text(f"{TABLE}[[joints]]{more}")
    relations = {"turn": "lead*-1+0.1", "tilt": "turn*0.5"}
    couple = {joint: relations[joint] for joint in order}
    related = read(Request(path, couple=couple))
    assert [joint.name for joint in related.dh.joints] == ["reach", "lead"]
    limits = related.dh.joints[1].limits  # -1 <= tilt <= 2, so -2 <= turn <= 3
    np.testing.assert_allclose([limits.lower, limits.upper], [-2.5, 2.1], atol=1e-15)
    turn = -0.3 + 0.1
    np.testing.assert_allclose(
        oracle_for(related).forward(np.array([[0.2, 0.3]])),
        oracle_for(read(Request(path))).forward(np.array([[turn, 0.5 * turn, 0.2, 0.3]])),
        atol=1e-15,
    )


def test_the_source_keeps_to_the_followers_limits(table: Path) -> None:
    limits = read(Request(table, couple={"tilt": "turn*0.5"})).dh.joints[0].limits
    assert (limits.lower, limits.upper) == (-2.0, 3.0)


@pytest.mark.parametrize(
    ("relation", "free", "error", "words"),
    [
        ("sideways", {}, UnknownNameError, "sideways"),
        ("tilt", {}, UsageError, "follows itself"),
        ("turn", {"tilt": None}, UsageError, "is held"),
        ("turn*1+9", {}, UsageError, "no range of values of 'turn'"),
    ],
)
def test_what_cannot_be_is_refused(
    table: Path, relation: str, free: dict[str, None], error: type, words: str
) -> None:
    with pytest.raises(error, match=words):
        read(Request(table, couple={"tilt": relation}, free=dict(free)))


@pytest.mark.parametrize("relation", ["turn*0.5", "turn*-0.5+0.2", "turn*2"])
def test_the_axis_that_turns_least_leads(table: Path, relation: str, tmp_path: Path) -> None:
    """A half ratio closes on the follower's variable, a whole one on the source's."""
    made = generate(Request(table, couple={"tilt": relation}), Outputs(out=tmp_path, samples=200))
    assert made.reports["python"].passed
