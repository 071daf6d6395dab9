"""Joints that follow others by request, and the stages of telescopes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.support.telescopes import STAGES, telescope_robot

from ikgen.chains.related_joints import equal_shares, equal_stages, related_tree, shared_limits
from ikgen.chains.selection import select_chain
from ikgen.derivation.read import read
from ikgen.errors import UnknownNameError, UsageError
from ikgen.generation.emitted_checks import oracle_for
from ikgen.importers import load_tree
from ikgen.model.joint_relation import Mimic
from ikgen.model.joint_tree import Limits
from ikgen.records.request import Request


def test_a_relation_moves_the_follower_and_takes_its_limits(tmp_path: Path) -> None:
    tree = load_tree(telescope_robot(tmp_path))
    related = related_tree(tree, {"stage_2": Mimic("stage_1", -2.0, 0.1)})
    chain = select_chain(related)
    # stage_1 and stage_2 slide in one direction: by q - 2 q together
    axis, alone = (
        next(axis for axis in of.axes if axis.name == "stage_1")
        for of in (chain, select_chain(tree))
    )
    np.testing.assert_allclose(axis.multiplier * axis.axis, -alone.axis, atol=1e-15)
    joint = chain.joints[axis.driver]
    assert joint.name == "stage_1"
    # 0.01 <= 0.1 - 2 q <= 0.14 and 0 <= q <= 0.13
    assert (joint.limits.lower, joint.limits.upper) == pytest.approx((0.0, 0.045))
    assert related.source.sha256 == tree.source.sha256


def test_what_is_odd_is_told_once_and_where_the_file_has_it(tmp_path: Path) -> None:
    path = telescope_robot(tmp_path)
    text = path.read_text().replace('lower="-1.5" upper="0.5"', 'lower="0.5"\n  upper="-1.5"')
    path.write_text(f"<!-- a robot\nof two lines -->\n{text}")
    tree = load_tree(path)
    related = related_tree(tree, {"stage_2": Mimic("stage_1", -2.0, 0.1)})
    assert len(tree.source.warnings) == 1
    assert related.source.warnings == tree.source.warnings
    assert [j.line for j in related.joints] == [j.line for j in tree.joints]


def test_the_oracle_follows_the_relation(tmp_path: Path) -> None:
    path = telescope_robot(tmp_path)
    reading = read(Request(path, couple={"stage_2": "stage_1*-2+0.1", "yaw": "pitch*2"}))
    whole = read(Request(path, free=dict.fromkeys(STAGES)))
    names = [joint.name for joint in reading.dh.joints]
    assert names == [
        "lift",
        "stage_1",
        "pitch",
    ]  # the other stages take shares equal to the first's
    q = np.array([0.3, 0.02, 0.2])
    full = np.array([0.3, 0.02, 0.1 - 2 * 0.02, 0.04, 0.05, 0.4, 0.2])
    np.testing.assert_allclose(
        oracle_for(reading).forward(q[None]), oracle_for(whole).forward(full[None]), atol=1e-15
    )


def test_unknown_joints_are_refused_with_those_that_there_are(tmp_path: Path) -> None:
    tree = load_tree(telescope_robot(tmp_path))
    with pytest.raises(UnknownNameError, match="stage_9"):
        related_tree(tree, {"stage_2": Mimic("stage_9", 1.0, 0.0)})


def test_limits_that_leave_nothing_are_refused() -> None:
    with pytest.raises(UsageError, match="no range of values of 'a'"):
        shared_limits(Mimic("a", 1.0, 5.0), "b", Limits(0.0, 1.0), Limits(0.0, 1.0))


def test_equal_stages_share_equally_from_their_lower_limits(tmp_path: Path) -> None:
    chain = select_chain(load_tree(telescope_robot(tmp_path)))
    stages = equal_stages(chain)
    assert tuple(stages) == STAGES[1:]
    assert {one.joint for one in stages.values()} == {"stage_1"}
    assert [one.offset for one in stages.values()] == pytest.approx([0.01, 0.02, 0.03])


def test_other_slides_are_no_telescope(tmp_path: Path) -> None:
    chain = select_chain(load_tree(telescope_robot(tmp_path, (0.1, 0.2, 0.3, 0.3))))
    assert tuple(equal_stages(chain)) == ("stage_4",)  # stages 3 and 4; the lift is across


def test_stages_that_slide_the_other_way_take_the_opposite_share(tmp_path: Path) -> None:
    path = telescope_robot(tmp_path)
    text = path.read_text()
    q = np.random.default_rng(0).uniform(0.0, 0.13, (5, 4))
    straight = oracle_for(read(Request(path))).forward(q)
    one = '<axis xyz="0 0 1"/><limit lower="0.02" upper="0.15"'
    assert one in text
    path.write_text(text.replace(one, '<axis xyz="0 0 -1"/><limit lower="-0.15" upper="-0.02"'))
    stages = equal_stages(select_chain(load_tree(path)))
    assert [one.multiplier for one in stages.values()] == [1.0, -1.0, 1.0]
    assert [one.offset for one in stages.values()] == pytest.approx([0.01, -0.02, 0.03])
    np.testing.assert_allclose(oracle_for(read(Request(path))).forward(q), straight, atol=1e-15)


def test_what_is_told_of_one_stage_leaves_the_others_their_shares(tmp_path: Path) -> None:
    path = telescope_robot(tmp_path)
    chain = select_chain(load_tree(path))
    assert tuple(equal_shares(chain, (), ("yaw",))) == STAGES[1:]
    assert tuple(equal_shares(chain, (), ("stage_3",))) == ("stage_2", "stage_4")
    assert equal_shares(chain, ("stage_2",), ("stage_3",)) == {}
    reading = read(Request(path, couple={"stage_3": "stage_2*0.5+0.02"}))
    assert [joint.name for joint in reading.dh.joints] == ["lift", "stage_1", "yaw", "pitch"]
    assert reading.coupled == ("stage_2=stage_1*1+0.01", "stage_4=stage_1*1+0.03")
    assert reading.relations == ("stage_3=stage_2*0.5+0.02", *reading.coupled)


def test_what_is_told_of_the_first_stage_makes_another_the_first(tmp_path: Path) -> None:
    path = telescope_robot(tmp_path)
    reading = read(Request(path, couple={"stage_1": "stage_3*2-0.04"}))
    assert [joint.name for joint in reading.dh.joints] == ["lift", "stage_2", "yaw", "pitch"]
    assert len(reading.coupled) == 2
    held = read(Request(path, free=dict.fromkeys(STAGES)))
    q = np.array([0.3, 0.04, 0.2, -0.1])  # stage_3 and stage_4 are 0.01 and 0.02 farther
    full = np.array([0.3, 2 * 0.05 - 0.04, 0.04, 0.05, 0.06, 0.2, -0.1])
    np.testing.assert_allclose(
        oracle_for(reading).forward(q[None]), oracle_for(held).forward(full[None]), atol=1e-15
    )


def test_limits_go_through_relations_in_any_order(tmp_path: Path) -> None:
    """stage_1, of 0 to 0.13, drives stage_2 that drives stage_3, of 0.02 to 0.15."""
    relations = {"stage_2": Mimic("stage_1", 1.0, 0.01), "stage_3": Mimic("stage_2", 2.0, 0.0)}
    for order in (relations, dict(reversed(relations.items()))):
        tree = related_tree(load_tree(telescope_robot(tmp_path)), order)
        found = next(joint.limits for joint in tree.joints if joint.name == "stage_1")
        assert (found.lower, found.upper) == pytest.approx((0.0, 0.065))


def test_held_stages_are_left_alone_and_a_locked_one_leaves_the_others_a_telescope(
    tmp_path: Path,
) -> None:
    path = telescope_robot(tmp_path)
    assert len(read(Request(path)).dh.joints) == 4
    assert len(read(Request(path, free={"stage_3": None})).dh.joints) == 7
    locked = read(Request(path, lock={"stage_3": 0.05}))
    assert len(locked.dh.joints) == 4
    assert len(locked.dh.rows) == 4  # the other stages are one row
