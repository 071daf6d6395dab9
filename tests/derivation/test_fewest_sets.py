from __future__ import annotations

import math
from pathlib import Path

import pytest

from ikgen.derivation.derive import derive
from ikgen.derivation.fewest_sets import with_fewest_sets
from ikgen.derivation.read import read
from ikgen.lowering.lower import lower
from ikgen.records.request import Request
from ikgen.solver.session import first_fork
from ikgen.solver.solve import solve_chain

pytestmark = pytest.mark.usefixtures("solved_once")

TABLES = Path(__file__).resolve().parents[1] / "robots" / "tables"


@pytest.mark.parametrize(
    ("name", "ranked", "fewest"),
    [("Bartell", 4, 2), pytest.param("Parkman13", 8, 4, marks=pytest.mark.long)],
)
def test_takes_another_first_branch_where_sets_never_hold_together(
    name: str, ranked: int, fewest: int
) -> None:
    graph = solve_chain(read(Request(TABLES / f"{name}.toml")).dh)
    assert math.prod(step.branches for step in graph.steps) == ranked
    request = Request(TABLES / f"{name}.toml", task="pose")
    assert derive(request).module.max_solutions == fewest


@pytest.mark.parametrize("name", ["Puma", "Wachtveitl", "Sims11"])
def test_keeps_a_form_whose_sets_all_hold_at_some_pose(name: str) -> None:
    graph = solve_chain(read(Request(TABLES / f"{name}.toml")).dh)
    tried: list[object] = []

    def solve(passed_over: object) -> object:
        tried.append(passed_over)
        return graph

    kept, program = with_fewest_sets(graph, lower, solve)  # type: ignore[arg-type]
    assert kept is graph
    assert program.max_solutions == math.prod(step.branches for step in graph.steps)
    assert not tried


def test_what_is_passed_over_is_not_the_first_with_branches() -> None:
    dh = read(Request(TABLES / "Bartell.toml")).dh
    first = first_fork(solve_chain(dh).steps)
    assert first is not None
    other = solve_chain(dh, passed_over=(first,))
    assert not other.open_joints
    assert first_fork(other.steps) not in (None, first)
