"""What `solved_once` puts in place of the solver is what derivations call."""

from __future__ import annotations

import sys

import pytest
from tests.support.tables import table

from ikgen.derivation.progress import silent
from ikgen.derivation.task_forms import by_rules
from ikgen.tasks import find_task

pytestmark = pytest.mark.usefixtures("solved_once")


@pytest.mark.skipif(sys.gettrace() is not None, reason="traced: chains are solved each time")
def test_equal_chains_are_solved_once() -> None:
    planar = [("R", 0, 0.0, 0.0), ("R", 0, 0.5, 0.0), ("R", 0, 0.4, 0.0)]
    first, again = (by_rules(table(*planar), find_task("pose"), silent) for _ in range(2))
    assert again is first
