"""What the entries of each group of other packages must be."""

from __future__ import annotations

import pytest

from ikgen.generation.checkup import _registry
from ikgen.generation.emitters import Emitter
from ikgen.importers import Importer
from ikgen.plugins import GROUPS
from ikgen.solver.behavior_tree import Tree
from ikgen.solver.leaves import Leaf
from ikgen.tasks import Task

KINDS = {
    "ikgen.importers": (Importer, None),
    "ikgen.emitters": (Emitter, "cpp"),
    "ikgen.leaves": (Leaf, None),
    "ikgen.tasks": (Task, "position"),
    "ikgen.trees": (Tree, None),
}


@pytest.mark.parametrize("group", GROUPS)
def test_every_group_has_its_class_and_the_names_that_are_taken(group: str) -> None:
    kind, taken = _registry(group)
    expected, name = KINDS[group]
    assert kind is expected and (name in taken if name else not taken)
