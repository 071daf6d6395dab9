"""Levels of a lowered arm: what each is told to decide, and the notes for the reader."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.support.tables import table

from ikgen.equations.knowledge import Variable
from ikgen.errors import PlugInError
from ikgen.forms.lowered_form import Tolerances
from ikgen.forms.quartic_form import TrigQuartic
from ikgen.lowering.frames import operand_of
from ikgen.lowering.lower import _or_seed, _routine, lower
from ikgen.lowering.placement import LoweredLevel, Placement
from ikgen.lowering.program_inputs import seed_values
from ikgen.program.interpret import evaluate
from ikgen.program.ops import operand_names
from ikgen.program.routines import TRIG_QUARTIC
from ikgen.program.statements import Comment, Let, Level, Program, Require
from ikgen.solver.solution_graph import SolutionGraph
from ikgen.solver.solve import solve_chain
from ikgen.tasks import find_task


@pytest.fixture(scope="module")
def graph() -> SolutionGraph:
    rows = table(("R", "0", 0.0, 0.2), ("R", "1", 0.0, 0.0), ("P", "1", 0.0, 0.0))
    return solve_chain(rows, readable=find_task("position").readable, tool_on_right=True)


@pytest.fixture(scope="module")
def program(graph: SolutionGraph) -> Program:
    return lower(graph)


def read_by(level: Level, name: str) -> set[str]:
    """Names that a name of a level depends on, through that level's own statements."""
    values = {s.name: s.value for s in level.body if isinstance(s, Let)}
    found: set[str] = set()
    stack = [name]
    while stack:
        new = operand_names(values[one]) if (one := stack.pop()) in values else set()
        stack += new - found
        found |= new
    return found


def test_a_level_tells_what_its_branches_decide(graph: SolutionGraph, program: Program) -> None:
    assert program.levels[0].solved == () and len(program.levels) > 1
    forks = [step for step in graph.steps if step.branches > 1]
    for level, step in zip(program.levels[1:], forks, strict=True):
        index = step.candidate.unknown.index
        letters = "cs" if step.candidate.unknown.kind == "angle" else "d"
        assert level.solved == tuple(f"{x}{index}" for x in letters)
        assert level.sigma == f"sigma_{index}"
        assert level.branches == step.branches
        assert any(level.sigma in read_by(level, name) for name in level.solved)


def test_a_reader_is_told_each_unknown_and_what_follows(
    graph: SolutionGraph, program: Program
) -> None:
    told = [s.text for level in program.levels for s in level.body if isinstance(s, Comment)]
    steps = [text for text in told if ", from (" in text]
    solved = [f"{s.candidate.unknown.text}: {s.candidate.leaf}" for s in graph.steps]
    assert [text.split(", from (")[0] for text in steps] == solved
    assert [text for text in told if text not in steps][-2:] == [
        "does the row reproduce the pose?", "joint values"
    ]  # fmt: skip
    body = program.levels[-1].body
    place = body.index(Comment("does the row reproduce the pose?"))
    after = body[place:]
    assert any(isinstance(s, Require) for s in after)
    lets = [s.name for level in program.levels for s in level.body if isinstance(s, Let)]
    assert sorted(name for name in lets if name[0] == "q") == ["q1", "q2"]  # the third is a length
    values = after[after.index(Comment("joint values")) + 1 :]
    assert values and all(isinstance(s, Let) and s.name in ("q1", "q2") for s in values)


def test_a_routine_s_roots_make_a_level_of_their_own() -> None:
    work = Placement(solve_chain(table(("R", "0", 0.0, 0.0), ("P", "1", 0.0, 0.0))), 0.0)
    g = work.g
    v = Variable("angle", (1, 0))
    a, b = (work.system.equations[i].left for i in (0, 1))
    form = TrigQuartic(a, b, g.zero, g.one, g.zero)
    lowered = form.lower(g, g.one, work.tolerances)
    work.loses_digits = True
    _routine(work, v, form, lowered, "theta_1: quartic")
    (fold,) = work.folds
    slope = work.slope(v, form)
    assert slope is not None and fold.op == "gt" and fold.args[1] is g.square(slope)
    assert fold.args[0].value == pytest.approx(1e-6 * np.abs(slope.probe).max() ** 2)
    level = work.levels[-1]
    assert (len(work.levels), level.branches, level.sigma) == (2, 4, None)
    assert level.call is not None
    routine, arguments, atoms = level.call
    assert routine is TRIG_QUARTIC and len(arguments) == 5
    assert atoms == work.knowledge.variables.pair((1, 0))
    assert [work.names[atom.id] for atom in atoms] == ["c1", "s1"]
    assert [work.level(atom) for atom in atoms] == [1, 1]
    assert level.items == [Comment("theta_1: quartic")]
    for e in arguments:
        assert work.level(e) == 0 and (not e.args or e.id in work.placed)


@pytest.mark.parametrize("name", ["cubic", "general_6r"])
def test_a_routine_that_finds_no_roots_is_refused(name: str) -> None:
    work = Placement(solve_chain(table(("R", "0", 0.0, 0.0), ("P", "1", 0.0, 0.0))), 0.0)
    g, v = work.g, Variable("angle", (1, 0))
    form = TrigQuartic(g.one, g.zero, g.zero, g.one, g.zero)
    lowered = replace(form.lower(g, g.one, work.tolerances), routine=name)
    with pytest.raises(PlugInError, match=f"'quartic' .* by a routine '{name}'") as refused:
        _routine(work, v, form, lowered, "theta_1: quartic")
    assert refused.value.hint == "there is: trig_quartic, trig_quartic_wide, trig_polynomial"


def test_where_a_routine_s_divisor_vanishes_its_root_is_the_seed_s() -> None:
    work = Placement(solve_chain(table(("R", "0", 0.0, 0.0), ("P", "1", 0.0, 0.0))), 0.0)
    g, v = work.g, Variable("angle", (1, 0))
    fixed = TrigQuartic(g.one, g.zero, g.zero, g.one, g.zero)
    assert _or_seed(work, v, fixed, fixed.lower(g, g.one, work.tolerances)) == fixed.coefficients
    assert not work.singular
    a = work.system.equations[0].left
    form = TrigQuartic(a, g.zero, g.zero, g.one, g.zero)
    lowered = form.lower(g, g.one, work.tolerances)
    found = _or_seed(work, v, form, lowered)
    assert [e.op for e in found] == ["select", "const", "select", "select", "const"]
    if lowered.divisor.regular is not None:
        assert all(e.args[0] is lowered.divisor.regular for e in found if e.op == "select")
    (flag,) = work.singular
    assert flag.op == "not" and flag.args[0] is lowered.divisor.clear and flag.id in work.placed
    wide = form.lower(g, g.one, Tolerances.for_model_error(1e-5))
    assert _or_seed(work, v, form, wide)[5] is wide.arguments[5]


def test_what_is_placed_costs_nothing_and_what_is_not_each_once() -> None:
    work = Placement(solve_chain(table(("R", "0", 0.0, 0.0), ("P", "1", 0.0, 0.0))), 0.0)
    g, a, b = work.g, work.atom("a"), work.atom("b")
    inner = g.binary("max", a, b)
    outer = g.binary("min", inner, g.binary("gt", inner, g.mul(g.param("a_9", 0.25), g.const(2.0))))
    assert work.price([]) == work.price([a, b]) == 0.0
    assert work.price([inner]) == 1.0 and work.price([outer]) == 3.0
    assert work.price([outer, inner, outer]) == 3.0
    sigma = g.atom("sigma", "0", np.ones(g.probes), unknown=False)
    work.levels.append(LoweredLevel(2, sigma))
    work.level_of[sigma.id] = 1
    deep = g.binary("min", inner, sigma)
    assert work.price([deep]) == 1.0 + 2.0
    work.place(inner)
    assert work.price([outer]) == 2.0 and work.price([deep]) == 2.0


def test_the_seed_s_value_of_sums_and_lengths_is_that_of_the_joints() -> None:
    dh = table(("R", "0", 0.0, 0.0), ("R", "1", 0.0, 0.0), ("P", "1", 0.0, 0.0))
    chain = solve_chain(table(("R", "0", 0.0, 0.0), ("P", "1", 0.0, 0.0)))
    work = Placement(chain, 0.0)
    assert dh.dof == 3 and seed_values(work, Variable("prismatic", (0, 1))) == (
        work.atom("seed_d2"),
    )
    angles = {1: 0.4, 2: -0.9}
    values = {
        f"seed_{x}{j}": f(angle)
        for j, angle in angles.items()
        for x, f in (("c", np.cos), ("s", np.sin))
    }
    for combination in ((1, 0), (0, 1), (1, 1), (1, -1), (-2, 1), (0, -1)):
        total = sum(k * angles[j + 1] for j, k in enumerate(combination))
        pair = seed_values(work, Variable("angle", combination))
        found = [evaluate(operand_of(e), values) for e in pair]
        assert found == pytest.approx([np.cos(total), np.sin(total)])
