"""The runtime takes its numbers from the one place that has them."""

from __future__ import annotations

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
