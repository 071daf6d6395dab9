"""Importers on published robots, traps and xacro packages, and against Pinocchio.

The collection lies where `benchmarks/collection.py` says; without it only the fixtures are compared.
"""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from benchmarks.collection import ABSENT, ARMS_FILE, CORPUS, load_arms
from tests.chains.test_selection import forward

from ikgen.chains.arms import candidate_chains
from ikgen.chains.selection import select_chain
from ikgen.errors import BadDescriptionError, IkgenError, UsageError
from ikgen.importers import load_tree

ROOT = Path(__file__).parents[3]
FIXTURES = sorted((ROOT / "urdf_fixtures").glob("*.urdf"))
collection = pytest.mark.skipif(not ARMS_FILE.is_file(), reason=ABSENT)


def table(name):
    file = CORPUS / name
    return json.loads(file.read_text()) if file.is_file() else []


ARMS = [arm for arm in load_arms() if "file" in arm]
ARMS_BY_NAME = {arm["name"]: arm for arm in ARMS}
TRAPS = table("traps/manifest.json")
XACROS = table("xacro/manifest.json")

# Where the default differs from the table's, on purpose.
OTHER_DEFAULT = {
    "lekiwi_arm": "no name on the last body is a convention",
    "xarm6_bullet": "link_base is preferred to world",
    "panthera": "the deepest link of the last body",
    "standardbots_core": "tool0 is preferred to flange",
    "openarm_v10": "hand_tcp is preferred to hand",
    "frankie_rtb": "the table's chain ends in a finger",
    "tiago_torso_arm": "base_link and arm_tool_link are preferred",
}


@cache
def tree_of(file):
    return load_tree(file)


@collection
@pytest.mark.parametrize("name", ARMS_BY_NAME)
def test_forward_kinematics_of_published_arms(name):
    arm = ARMS_BY_NAME[name]
    chain = select_chain(tree_of(CORPUS / arm["file"]), arm["base_link"], arm["tip_link"])
    assert chain.dof == arm["dof"]
    independent = [j for j in arm["chain"] if j["type"] != "fixed" and "mimic" not in j]
    assert [joint.name for joint in chain.joints] == [joint["joint"] for joint in independent]
    for sample in arm["sample_fk"]:
        np.testing.assert_allclose(forward(chain, sample["q"]), sample["T"], atol=1e-12)


@collection
@pytest.mark.parametrize("name", ARMS_BY_NAME)
def test_default_chain_of_published_arms(name):
    arm = ARMS_BY_NAME[name]
    tree = tree_of(CORPUS / arm["file"])
    moving = tuple(joint["joint"] for joint in arm["chain"] if joint["type"] != "fixed")
    try:
        chain = select_chain(tree)
    except UsageError as error:
        assert "--tip" in error.hint
        offered = {candidate.joints for candidate in candidate_chains(tree)}
        if name != "nao_rarm_bullet":  # whose table ends behind the joint that closes the hand
            assert moving in offered
        return
    ends = (chain.base_link, chain.tip_link)
    assert (ends == (arm["base_link"], arm["tip_link"])) == (name not in OTHER_DEFAULT)
    if name != "frankie_rtb":
        axes = [axis.name for axis in chain.axes]
        assert axes == [joint for joint in moving if joint in axes]
        followers = {joint.name for joint in tree.joints if joint.mimic is not None}
        assert followers.issuperset(set(moving) - set(axes))  # linkages that are one axis


@collection
@pytest.mark.parametrize("trap", TRAPS, ids=lambda trap: trap["file"])
def test_traps_are_read_or_refused_in_words(trap):
    file = CORPUS / "traps" / trap["file"]
    try:
        tree = load_tree(file)
    except BadDescriptionError as error:
        assert error.file == str(file) and error.line and error.hint
    else:
        assert trap["file"].startswith(("mimic_missing", "limit_without", "prismatic", "negative"))
        assert tree.links
        assert all(abs(np.linalg.norm(joint.axis) - 1.0) < 1e-15 for joint in tree.joints)


@collection
@pytest.mark.parametrize("row", XACROS, ids=lambda row: row["name"])
def test_published_xacro_packages(row):
    folder = CORPUS / "xacro"
    tree = load_tree(
        folder / row["tree"] / row["top"],
        arguments=row["args"],
        package_paths=[folder / path for path in row["find"].values()],
    )
    expected = tree_of(CORPUS / row["expected"])
    assert (set(tree.links), tree.root_link) == (set(expected.links), expected.root_link)
    assert str(CORPUS) not in tree.source.text
    joints = {joint.name: joint for joint in tree.joints}
    assert set(joints) == {joint.name for joint in expected.joints}
    for other in expected.joints:
        joint = joints[other.name]
        ends = (joint.type, joint.parent, joint.child, joint.limits, joint.mimic)
        assert ends == (other.type, other.parent, other.child, other.limits, other.mimic)
        np.testing.assert_array_equal(joint.T_parent_child, other.T_parent_child)
        np.testing.assert_array_equal(joint.axis, other.axis)


@pytest.mark.parametrize("file", FIXTURES, ids=lambda file: file.stem)
def test_every_link_lies_where_pinocchio_has_it(file):
    pin = pytest.importorskip("pinocchio")
    tree = load_tree(file)
    model = pin.buildModelFromXML(tree.source.text)
    data = model.createData()
    generator = np.random.default_rng(1)
    for link in tree.links:
        try:
            chain = select_chain(tree, tree.root_link, link)
        except IkgenError:
            continue  # rigidly attached to the root
        values = {joint.name: generator.uniform(-1, 1) for joint in chain.joints}
        q = pin.neutral(model)
        for axis in chain.axes:
            value = axis.multiplier * values[chain.joints[axis.driver].name] + axis.offset
            joint = model.joints[model.getJointId(axis.name)]
            q[joint.idx_q : joint.idx_q + joint.nq] = (
                [value] if joint.nq == 1 else [np.cos(value), np.sin(value)]
            )
        pin.framesForwardKinematics(model, data, q)
        frame = model.getFrameId(link, pin.FrameType.BODY)
        expected = data.oMf[frame].homogeneous
        np.testing.assert_allclose(forward(chain, list(values.values())), expected, atol=4e-15)
