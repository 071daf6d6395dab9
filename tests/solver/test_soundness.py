"""Whether a step holds at every regular configuration, and what is done where one does not."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from tests.support.serial_urdf import serial_urdf

from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.derivation import derive as derivation
from ikgen.derivation import task_forms
from ikgen.derivation.held_joints import held_choices
from ikgen.derivation.read import read
from ikgen.equations.equation_set import EquationSet
from ikgen.equations.knowledge import Knowledge
from ikgen.equations.probes import arm_size, make_probes, smallest_singular
from ikgen.records.request import Request
from ikgen.solver import soundness
from ikgen.solver.choice import Chooser
from ikgen.solver.leaves import all_leaves
from ikgen.solver.session import Session
from ikgen.solver.solve import solve_chain
from ikgen.tasks import find_task
from ikgen.tasks.fitting import over_constrained

ROOT = Path(__file__).resolve().parents[2]
FIVE_JOINTS = ROOT / "urdf_fixtures" / "igus_robolink_rl_dp_5.urdf"
PUMA = ROOT / "tests" / "robots" / "tables" / "Puma.toml"


def session_of(table: Path) -> Session:
    """A session with the candidates of its first round."""
    dh = read(Request(table)).dh
    probes = make_probes(dh)
    system = EquationSet(ExpressionGraph(len(probes.values)), dh, probes.values, probes.pose)
    session = Session(system, probes, Knowledge(system))
    session.start()
    session.collect()
    for leaf in all_leaves():
        session.try_leaf(leaf)
    return session


def test_only_a_weak_candidate_makes_an_unsound_step() -> None:
    session = session_of(PUMA.with_name("Craig417.toml"))
    chooser = Chooser(session.system, session.probes)
    weak = [c for c in session.candidates if c.is_weak]
    assert weak, "the test needs a weak candidate"
    step = chooser.choose(weak[:1], anything=True)
    assert step is not None and not step.sound
    best = chooser.choose(session.candidates, anything=False)
    assert best is not None and best.sound


def test_regular_is_what_the_task_reads() -> None:
    """With the tool along the last axis, that joint turns nothing of the direction: the whole pose is
    regular there, the task is not."""
    dh, task = read(Request(FIVE_JOINTS)).dh, find_task("position-direction")
    probes = make_probes(dh, tool=True)
    q = probes.values[: probes.regular]
    size = arm_size(dh)
    whole = smallest_singular(dh, q, size)
    read_alone = smallest_singular(dh, q, size, readable=task.readable, tool=True)
    assert (whole > 1e-2).all() and (read_alone < 1e-8).any()
    own = make_probes(dh, tool=True, readable=task.readable)
    special = own.values[own.generic : own.regular]
    assert len(special) and np.all(
        smallest_singular(dh, special, size, readable=task.readable, tool=True) > 1e-2
    )


def test_an_arm_that_is_nowhere_far_from_singular_has_regular_configurations(
    tmp_path: Path,
) -> None:
    """The first two axes are 0.3 degrees from parallel. A pose without rows once came of a divisor that
    vanishes where the arm is as regular as it gets."""
    text = PUMA.with_name("Puma_paper.toml").read_text("utf-8")
    table = tmp_path / "table.toml"
    table.write_text(
        text.replace('"-pi/2"', '"alpha_1"', 1).replace(
            "d_3 = 0.1245", "d_3 = 7.2\nalpha_1 = 0.0055"
        )
    )
    reading = read(Request(table))
    probes = make_probes(reading.dh)
    assert probes.typical < 1e-2 and probes.regular > probes.generic
    assert not over_constrained(reading.dh, find_task("pose"))
    graph = solve_chain(reading.dh)
    assert graph.sound and not held_choices(reading, find_task("pose"))


def test_divisors_may_vanish_where_the_task_is_singular() -> None:
    dh, task = read(Request(FIVE_JOINTS)).dh, find_task("position-direction")
    graph = solve_chain(dh, readable=task.readable, tool_on_right=True)
    assert not graph.open_joints and graph.sound


def test_the_elimination_is_taken_where_a_step_is_unsound(monkeypatch: pytest.MonkeyPatch) -> None:
    by_rules = task_forms.by_rules

    def unsound(*arguments: object) -> object:
        graph = by_rules(*arguments)  # type: ignore[arg-type]
        first = dataclasses.replace(graph.steps[0], sound=False)
        return dataclasses.replace(graph, steps=(first, *graph.steps[1:]))

    assert derivation.derive(Request(PUMA)).module.plan is None
    monkeypatch.setattr(task_forms, "by_rules", unsound)
    found = derivation.derive(Request(PUMA))
    assert not found.graph.sound
    assert found.module.plan is not None


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_descent_takes_twelve_steps_of_half_a_radian(
    way: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of a condition that vanishes far away; one near is met."""
    candidate = SimpleNamespace()
    variables = SimpleNamespace(
        primary=(SimpleNamespace(revolute=True), SimpleNamespace(revolute=False))
    )
    system = SimpleNamespace(variables=variables)
    start, size = np.array([[0.25, 1.0]]), 3.0

    def ending(joint: int, zero: float) -> np.ndarray:
        monkeypatch.setattr(soundness, "conditions", lambda c, s, q: [(q[:, joint] - zero)[None]])
        return soundness._descend(candidate, system, start, 0, size) - start  # type: ignore[arg-type]

    assert ending(0, 100.0 * way)[0] == pytest.approx([6.0 * way, 0.0])
    assert ending(1, 100.0 * way)[0] == pytest.approx([0.0, 6.0 * size * way])
    assert ending(0, 0.25 + 2.2 * way)[0] == pytest.approx([2.2 * way, 0.0], abs=1e-9)


@pytest.mark.filterwarnings("error")
def test_conditions_that_are_nowhere_finite_warn_of_nothing(tmp_path: Path) -> None:
    """Those of a step that a rounded arm does not have."""
    rounded = (("0 0 0.304", "0 0 0"), ("-0.14 0.523 0", "-1.5708 0 0"))
    rounded += (("-0.579 0 0", "-1.5708 0 0"), ("0.343 0 0", "0 0 0"))
    tip = ("0 0 0.078", "0 0 0")
    path = serial_urdf(tmp_path / "arm.urdf", rounded, slides={0: "0 0 1"}, tip=tip, limit=3.2)
    assert not derivation.derive(Request(path)).graph.open_joints
