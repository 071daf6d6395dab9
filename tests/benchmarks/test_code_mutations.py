"""Small changes of code: each parses, changes something, and stands where it says."""

from __future__ import annotations

import ast

import pytest
from benchmarks.code_mutations import code_mutations
from benchmarks.command_line import REPOSITORY
from benchmarks.mutation_score import PACKAGES, Done, drawn, files_for, score

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
        for mutation in code_mutations(text)[::10]:
            assert ast.dump(ast.parse(mutation.applied(text))) != same, mutation


def test_a_seed_draws_the_same_of_all_packages() -> None:
    first = drawn(1)
    assert first == drawn(1) != drawn(2)
    assert {path.split("/")[0] for path, _ in first} == set(PACKAGES)


def test_tests_near_a_module_come_first() -> None:
    files = files_for("runtime/python/path_following.py")
    assert files.index("tests/conformance/test_follow.py") < files.index(
        "tests/robots/test_tables.py"
    )
    assert not any("golden" in file for file in files)


def test_the_score_is_by_package() -> None:
    mutation = code_mutations(b"x = 1\n")[0]
    rows = [("forms/a.py", "t"), ("forms/a.py", ""), ("emit/b.py", "too late")]
    assert score([Done(path, mutation, by, 1.0) for path, by in rows]) == {
        "forms": (1, 2),
        "emit": (1, 1),
    }
