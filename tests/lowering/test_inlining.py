"""What gets a name of its own: what is long, used twice, or used deeper than it is computed."""

from __future__ import annotations

from dataclasses import replace

import pytest
from tests.support.tables import table

from ikgen.algebra.expression import Expr
from ikgen.lowering.placement import LoweredLevel, Placement
from ikgen.lowering.serialize import serialize
from ikgen.program.ops import Op, Operand
from ikgen.program.routines import TRIG_QUARTIC
from ikgen.program.statements import Call, Let, Level, Require
from ikgen.solver.solution_graph import SolutionGraph
from ikgen.solver.solve import solve_chain


@pytest.fixture(scope="module")
def solved() -> SolutionGraph:
    return solve_chain(table(("R", "0", 0.0, 0.0), ("P", "1", 0.0, 0.0)))


@pytest.fixture
def work(solved: SolutionGraph) -> Placement:
    """Before any step."""
    return Placement(replace(solved, steps=()), 0.0)


def running(work: Placement, count: int, start: str = "in") -> Expr:
    """The largest of inputs, in so many operations."""
    found = work.atom(f"{start}0")
    for i in range(count):
        found = work.g.binary("max", found, work.atom(f"{start}{i + 1}"))
    return found


def length(operand: Operand) -> int:
    return 1 + sum(map(length, operand.args)) if isinstance(operand, Op) else 0


def levels(work: Placement, *values: Expr) -> tuple[Level, ...]:
    return serialize(work, list(enumerate(values))).levels


def lets(level: Level) -> dict[str, int]:
    """Names and how many operations each stands for."""
    return {s.name: length(s.value) for s in level.body if isinstance(s, Let)}


@pytest.mark.parametrize(
    ("count", "named", "last"),
    [(1, [], 2), (8, [], 9), (9, [10], 0), (10, [10], 1), (18, [10], 9), (19, [10, 10], 0)],
)
def test_what_is_used_once_is_written_there_up_to_nine_operations(
    work: Placement, count: int, named: list[int], last: int
) -> None:
    work.require(work.g.binary("gt", running(work, count), work.g.zero), fold=True)
    (level,) = levels(work)
    assert list(lets(level).values()) == named
    guard = level.body[-1]
    assert isinstance(guard, Require) and guard.fold and length(guard.condition) == last
    booleans = [s.boolean for s in level.body if isinstance(s, Let)]
    assert booleans == [False] * (len(named) - 1) + [last == 0] if named else not booleans


def test_what_is_used_twice_has_a_name(work: Placement) -> None:
    g, once = work.g, running(work, 2)
    for bound in (0.5, 1.5):
        work.require(g.binary("gt", once, g.const(bound)))
    (level,) = levels(work)
    (name,) = lets(level)
    assert [s.condition for s in level.body if isinstance(s, Require)] == [
        Op("gt", (name, 0.5)), Op("gt", (name, 1.5))
    ]  # fmt: skip


def test_what_a_deeper_level_uses_has_a_name(work: Placement) -> None:
    g, outer, constant = work.g, running(work, 1), work.g.param("a_9", 0.25)
    sigma = g.atom("sigma", "0", [1.0] * g.probes, unknown=False)
    work.place(outer)
    work.levels.append(LoweredLevel(2, sigma))
    work.level_of[sigma.id], work.names[sigma.id] = 1, "sigma_1"
    twice = g.binary("max", constant, g.const(0.5))
    work.require(g.binary("gt", g.binary("min", outer, sigma), twice))
    first, second = levels(work)
    assert list(lets(first).values()) == [1] and not lets(second)
    assert (second.sigma, second.branches, second.call) == ("sigma_1", 2, None)
    (guard,) = second.body
    (name,) = lets(first)
    program = serialize(work, [])
    (made,) = program.constants
    assert made.value == Op("max", ("a_9", 0.5)) and made.name == "k1"
    assert guard == Require(Op("gt", (Op("min", (name, "sigma_1")), "k1")), False)
    assert [(one.name, one.value) for one in program.parameters] == [("a_9", 0.25)]


def test_results_flags_and_residuals_have_names(work: Placement) -> None:
    value, flag, off = (running(work, 2, start) for start in ("u", "v", "w"))
    work.singular.append(flag)
    work.residuals.append(off)
    for e in (value, flag, off):
        work.place(e)
    program = serialize(work, [(0, value)])
    names = [output.value for output in program.outputs], program.singular, program.residuals
    assert sum(map(len, names)) == 3 and list(lets(program.levels[0])) == [
        n for part in names for n in part
    ]


def test_arguments_of_a_routine_are_written_in_its_call(work: Placement) -> None:
    """Those of the level before alone; of an outer level they have names."""
    g, outer = work.g, running(work, 1, "u")
    work.place(outer)
    sigma = g.atom("sigma", "0", [1.0] * g.probes, unknown=False)
    work.levels.append(LoweredLevel(2, sigma))
    work.level_of[sigma.id], work.names[sigma.id] = 1, "sigma_1"
    inner = g.binary("min", sigma, work.atom("v"))
    work.place(inner)
    roots = tuple(g.atom("root", name, [0.5] * g.probes, unknown=False) for name in "cs")
    work.levels.append(LoweredLevel(4, None, (TRIG_QUARTIC, (outer, inner, g.const(0.5)), roots)))
    for atom, name in zip(roots, "cs", strict=True):
        work.level_of[atom.id], work.names[atom.id] = 2, name
    first, second, third = levels(work)
    (name,) = lets(first)
    assert not lets(second) and not lets(third)
    assert third.call == Call(TRIG_QUARTIC, (name, Op("min", ("sigma_1", "v")), 0.5), ("c", "s"))
    assert (third.branches, third.sigma, third.solved) == (4, None, ())
