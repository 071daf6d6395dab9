"""Texts that say what a joint follows."""

from __future__ import annotations

import pytest

from ikgen.model.joint_relation import Mimic, read_relation


@pytest.mark.parametrize(
    ("text", "terms", "offset"),
    [
        ("a", [("a", 1.0)], 0.0),
        ("a*-2-.5", [("a", -2.0)], -0.5),
        ("a*1+b*-1", [("a", 1.0), ("b", -1.0)], 0.0),
        ("a*1-b*2+1e-3", [("a", 1.0), ("b", -2.0)], 1e-3),
        ("joint-1*2e-1-joint-2*3-4", [("joint-1", 0.2), ("joint-2", -3.0)], -4.0),
        ("a*2 + b c*3 - 4", [("a", 2.0), ("b c", 3.0)], -4.0),
    ],
)
def test_sources_with_their_factors_and_a_constant(
    text: str, terms: list[tuple[str, float]], offset: float
) -> None:
    found = read_relation(text)
    assert list(found.terms) == terms and found.offset == offset


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "is not"),
        ("a*", "is not"),
        ("*2", "is not"),
        ("a*1+", "is not"),
        ("a*1+b", "is not"),
        ("a*2*3", "is not"),
        ("a*1e999", "no finite number"),
        ("a*0", "holds the joint still"),
        ("a*1+b*0", "'b' has the factor 0"),
        ("a*1+b*2-a*2", "'a' is named twice"),
    ],
)
def test_what_is_no_relation(text: str, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        read_relation(text)


def test_one_other_joint_is_followed_and_all_else_is_of_motors() -> None:
    assert read_relation("a*2+1").mimic("b") == Mimic("a", 2.0, 1.0)
    assert read_relation("a*2+1").mimic("a") is None
    assert read_relation("a*2+b*1").mimic("b") is None
    assert read_relation("a*2+b*1").mimic("c") is None


@pytest.mark.parametrize(
    ("multiplier", "offset", "words"),
    [(1.0, 0.0, "a"), (1.0, 0.5, "a*1+0.5"), (-1.0, 0.0, "a*-1"), (0.1, -0.0, "a*0.1")],
)
def test_what_a_joint_follows_is_written_as_it_is_read(
    multiplier: float, offset: float, words: str
) -> None:
    mimic = Mimic("a", multiplier, offset)
    assert mimic.words == words and read_relation(words).mimic("b") == mimic
