"""Numbers in words."""

from __future__ import annotations

import pytest

from ikgen.model.counted import counted, with_article
from ikgen.model.dh import Snap


@pytest.mark.parametrize(
    ("count", "thing", "words"),
    [
        (1, "joint", "1 joint"),
        (0, "joint", "0 joints"),
        (1, "joint move", "1 joint moves"),
        (3, "joint move", "3 joints move"),
    ],
)
def test_one_is_one(count: int, thing: str, words: str) -> None:
    assert counted(count, thing) == words


def test_numbers_that_differ_look_different() -> None:
    assert Snap("a", 0.1, 0.2).texts == ("0.1", "0.2")
    assert Snap("a", 1.57079632679, 1.5707963267948966).texts == (
        "1.57079632679",
        "1.5707963267949",
    )
    before, after = Snap("a", 0.1, 0.1 + 1e-17 + 2e-17).texts
    assert before != after


@pytest.mark.parametrize(("word", "words"), [("int", "an int"), ("list", "a list"), ("", "a ")])
def test_vowels_take_another_article(word: str, words: str) -> None:
    assert with_article(word) == words
