"""Small changes of code: each parses, changes something, and stands where it says."""

from __future__ import annotations

import ast

import pytest
from benchmarks.code_mutations import code_mutations
from benchmarks.command_line import REPOSITORY
from benchmarks.function_codes import surrounding
from benchmarks.harmless_changes import HARMLESS, HarmlessChange, why_harmless
from benchmarks.mutation_score import PACKAGES, Done, chosen, drawn, score
from benchmarks.reached_functions import Reach

TEXT = b'''"""Doc 1."""
from typing import TYPE_CHECKING
if TYPE_CHECKING:
    import one
__all__ = ["f"]
LIMIT: int = 3

def f(x: "int | None" = 2) -> float:
    """Not 4."""
    while x < 1.5 and not x is None:
        x += 1
        g(-x)
    return x * 2 if x else True
'''


def test_what_is_changed_and_to_what() -> None:
    found = {(m.line, m.old, m.new) for m in code_mutations(TEXT)}
    assert found == {
        (6, "3", "4"), (8, "2", "3"), (10, "<", "<="), (10, "<", ">"), (10, "1.5", "2.5"),
        (10, "and", "or"), (10, "not x is None", "(x is None)"), (10, "is", "is not"),
        (10, "x < 1.5 and not x is None", "not (x < 1.5 and not x is None)"),
        (11, "x += 1", "pass"), (11, "1", "2"), (12, "g(-x)", "pass"), (12, "-x", "(x)"),
        (13, "*", "/"), (13, "2", "3"), (13, "x", "not (x)"), (13, "True", "False"),
    }  # fmt: skip


@pytest.mark.parametrize("package", PACKAGES)
def test_all_of_a_package_parse_and_differ(package: str) -> None:
    for path in sorted((REPOSITORY / "src/ikgen" / package).rglob("*.py")):
        text = path.read_bytes()
        same = ast.dump(ast.parse(text))
        for mutation in code_mutations(text)[::30]:
            assert ast.dump(ast.parse(mutation.applied(text))) != same, mutation


def test_a_seed_draws_the_same_of_all_packages() -> None:
    first = drawn(1)
    assert first == drawn(1) != drawn(2)
    assert {path.split("/")[0] for path, _ in first} == set(PACKAGES)


def test_the_function_around_a_change_is_found() -> None:
    text = b"""LIMIT = 3
class A:
    size = 4
    def f(self, x=5):
        def g(): return 6
        return g()
def h(x): return x + 7
TABLE = [lambda: 8]
"""
    found = {m.old: surrounding(text, m) for m in code_mutations(text) if m.old in "345678"}
    assert found == {"3": None, "4": None, "5": None, "6": "A.f", "7": "h", "8": None}


def test_tests_that_reach_a_function_run_those_of_its_module_first() -> None:
    def reach(seconds: float, *functions: str) -> Reach:
        return Reach(seconds, frozenset(functions))

    every = {
        "tests/runtime/test_rows.py::late": reach(0.7, "emitted::follow"),
        "tests/runtime/test_rows.py::soon": reach(0.1, "emitted::follow"),
        "tests/conformance/test_follow.py::near": reach(
            2.0, "runtime/python/solving/path_following.py::_follow"
        ),
        "tests/conformance/test_follow.py::other": reach(
            0.1, "runtime/python/solving/path_following.py::start"
        ),
        "tests/golden/test_python_module.py::golden": reach(0.1, "emitted::follow"),
        "tests/forms/test_form.py::none": reach(0.1, "forms/form.py::follow"),
        "tests/forms/test_form.py::long": reach(90.0, "emitted::follow"),
    }
    path = "runtime/python/solving/path_following.py"
    assert list(chosen(path, "_follow", every)) == [
        "tests/conformance/test_follow.py::near",
        "tests/runtime/test_rows.py::soon",
        "tests/runtime/test_rows.py::late",
    ]
    assert list(chosen(path, None, every)) == [
        "tests/conformance/test_follow.py::other",
        "tests/conformance/test_follow.py::near",
    ]
    assert chosen("forms/form.py", "follow", every) == {"tests/forms/test_form.py::none": 0.1}


def test_the_score_is_by_package() -> None:
    mutation = code_mutations(b"x = 1\n")[0]
    rows = [("forms/form.py", "t"), ("forms/form.py", ""), ("emit/printer.py", "too late")]
    assert score([Done(path, mutation, by, 1.0) for path, by in rows]) == {
        "forms": (1, 2, 0),
        "emit": (1, 1, 0),
    }


@pytest.mark.parametrize("one", HARMLESS, ids=lambda one: f"{one.path}: {one.old} to {one.new}")
def test_changes_that_are_said_to_be_harmless_are_there(one: HarmlessChange) -> None:
    text = (REPOSITORY / "src" / "ikgen" / one.path).read_bytes()
    lines = text.decode().splitlines()
    there = [m for m in code_mutations(text) if lines[m.line - 1].strip() == one.line]
    same = [m for m in there if (m.old, m.new) == (one.old, one.new)]
    assert same and {why_harmless(one.path, text, m) for m in same} == {one.why} != {""}


def test_changes_that_are_said_to_be_harmless_are_said_once() -> None:
    assert len(set(HARMLESS)) == len(HARMLESS)
