"""What is tried for an arm that no closed form was found for."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

from tests.support.solving import FIXTURES

from ikgen.derivation.read import read
from ikgen.derivation.remedies import _choices
from ikgen.records.request import Request
from ikgen.tasks import find_task
from ikgen.tasks.fitting import over_constrained


def test_no_smaller_task_is_tried_that_fixes_more_than_the_joints_move() -> None:
    """Of a SCARA's four joints three move the position and a direction, two of its five freedoms not."""
    reading = read(Request(FIXTURES / "scara_standard.toml"))
    unsolved = SimpleNamespace(reading=reading, task=find_task("pose"))
    tried = list(_choices(unsolved))  # type: ignore[arg-type]
    assert over_constrained(reading.dh, find_task("position-direction"))
    assert {task.name for task, _ in tried} >= {"position-yaw", "position"}
    for task, choice in tried:
        chain = reading.dh if choice is None else replace(reading.dh, free=choice.held)
        assert not over_constrained(chain, task)
