"""What rows are told apart by, for arms with sides and without."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from tests.support.cpp_modules import robot_file

from ikgen.derivation.read import read
from ikgen.emit.python import branch_kinds
from ikgen.emit.python.branch_kinds import branch_kind, elbow_end
from ikgen.records.request import Request
from ikgen.tasks import find_task


@pytest.mark.parametrize(
    ("name", "kind", "end"),
    [
        ("kuka_kr6r900sixx", "names", 5),
        ("ur5e", "names", 3),
        ("Raven-II", "number", 5),
        ("Stanford", "number", 5),
        ("scara_standard", "number", 3),
    ],
)
def test_arms_with_a_shoulder_an_elbow_and_a_wrist(name: str, kind: str, end: int) -> None:
    dh = read(Request(robot_file(name))).dh
    module = SimpleNamespace(plan=None, dh=dh, reads=find_task("pose"), free_indices=(), lanes=8)
    assert branch_kind(module) == kind
    if kind == "names":
        assert elbow_end(module) == end
    for other in ({"reads": find_task("position")}, {"free_indices": (0,)}, {"lanes": 4}):
        assert branch_kind(SimpleNamespace(**{**vars(module), **other})) == "number"
    assert branch_kind(SimpleNamespace(**{**vars(module), "plan": object()})) == "orientation"


ELBOW = {
    "kinds": "RRRRRR", "perpendicular_pairs": (1,), "parallel_pairs": (2,),
    "parallel_triples": (), "spherical_triples": (4,), "intersecting_pairs": (),
}  # fmt: skip
PARALLEL = {
    **ELBOW, "spherical_triples": (), "parallel_triples": (2,), "intersecting_pairs": (4, 5),
}  # fmt: skip


@pytest.mark.parametrize("whole", [ELBOW, PARALLEL], ids=["spherical wrist", "three parallel axes"])
def test_each_trait_of_an_elbow_arm_is_needed(
    whole: dict[str, object], monkeypatch: pytest.MonkeyPatch
) -> None:
    dh = SimpleNamespace(dof=6, rows=(None,) * 6)
    module = SimpleNamespace(plan=None, dh=dh, reads=find_task("pose"), free_indices=(), lanes=8)

    def kind(**other: object) -> str:
        geometry = SimpleNamespace(**{**whole, **other})
        monkeypatch.setattr(branch_kinds, "classify", lambda _: geometry)
        return branch_kind(module)

    assert kind() == "names"
    for trait, value in whole.items():
        if value and trait != "kinds":
            assert kind(**{trait: ()}) == "number", trait
    assert kind(kinds="RRRRRP") == "number"
    if whole is PARALLEL:
        assert kind(intersecting_pairs=(4,)) == kind(intersecting_pairs=(5,)) == "number"
