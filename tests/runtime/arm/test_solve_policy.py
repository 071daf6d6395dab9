"""The runtime takes its numbers from the one place that has them."""

from __future__ import annotations

import inspect
import re
from dataclasses import MISSING, fields

from ikgen.elimination.routine import runtime_policy
from ikgen.program.policy import SolvePolicy
from ikgen.runtime.python.arm.solve_policy import Policy


def test_every_number_is_the_policys() -> None:
    given = SolvePolicy(coincident=2e-6, tries=5)
    taken = runtime_policy(given)
    for field in fields(Policy):
        if field.name != "refinement":
            assert getattr(taken, field.name) == getattr(given, field.name)
    stages = [(s.steps, s.fine, s.promising) for s in given.refinement]
    assert list(taken.refinement) == stages


def test_the_runtime_has_no_defaults_of_its_own() -> None:
    assert all(field.default is MISSING for field in fields(Policy))


ELSEWHERE = {
    "rough_square": "a number in the closed form",
    "meeting": "of C++ alone",
    "fold": "what makes `fold_reach` and `beside_reach` of a deviation",
    "near": "of C++ alone",
}
"""What the runtime does not read, and where it is instead."""


def test_both_have_the_same_numbers_in_the_same_order() -> None:
    names = [field.name for field in fields(SolvePolicy)]
    assert ELSEWHERE.keys() <= set(names)
    read = [name for name in names if name not in ELSEWHERE]
    assert [field.name for field in fields(Policy)] == read


def test_both_say_the_same_of_them() -> None:
    text = " ".join((inspect.getdoc(SolvePolicy) or "").split()) + " - `"
    said = dict(re.findall(r"- `(\w+)`: (.*?)(?= - `)", text))
    assert list(said) == [field.name for field in fields(SolvePolicy)]
    short = dict(re.findall(r"^    (\w+): .*?  # (.*)$", inspect.getsource(Policy), re.MULTILINE))
    assert list(short) == [field.name for field in fields(Policy)]
    for name, words in short.items():
        plain = words.removeprefix("rad or m: ")
        assert (plain != words) == (" (rad or m)" in said[name]), name
        assert said[name].replace(" (rad or m)", "").startswith(plain), name
