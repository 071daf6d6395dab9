"""The chains of a tree that someone may want solved: its arms, without their grippers.

A tree does not say where its arms begin and end. With the fingers taken off (`fingers`), its long
branches are the arms; short side branches (the parallel rods of a palletiser, wheels) and heads
are none. The ends are chosen by conventional names among the links rigidly attached there.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import takewhile

from ikgen.chains.grippers import ARM_JOINTS, arm_links, hub_of, rigid_body
from ikgen.chains.link_names import NO_RANK, base_rank, is_head, is_sensor, tip_rank
from ikgen.importers.urdf.topology import TreeIndex
from ikgen.model.joint_tree import Joint, JointTree, JointType

__all__ = ["ChainCandidate", "candidate_chains", "conventional_base"]


@dataclass(frozen=True, slots=True)
class ChainCandidate:
    """One chain of a tree: its ends, its moving joints from base to tip, and why it was chosen.

    `dof` counts independent joints: a mimic joint follows its driver.
    """

    base: str
    tip: str
    joints: tuple[str, ...]
    dof: int
    why: str


def candidate_chains(tree: JointTree, base: str | None = None) -> tuple[ChainCandidate, ...]:
    """The arms of a tree, longest first; those that start at `base` where it is given.

    Arms that share a trunk (a torso) are listed with the trunk and again from where they part.
    """
    index = TreeIndex.of(tree)
    root = tree.root_link if base is None else base
    index.require_link(root)
    arms = _without_side_branches(list(_branches(index, root, base)))
    if base is None:
        arms += [split for arm in arms if (split := _without_trunk(index, arm, arms)) is not None]
    return tuple(sorted(arms, key=lambda arm: -arm.dof))


def conventional_base(index: TreeIndex, root: str, tip: str) -> str:
    """Where the chain to `tip` begins.

    A link named as a base on the rigid way from the root to the first moving joint, else the root;
    below the last floating or planar joint where there is one.
    """
    path = index.path(root, tip) or ()
    start = _after_floating(path)
    first = next(
        (i for i, j in enumerate(path) if i >= start and j.type is not JointType.FIXED), len(path)
    )
    rigid = [path[start].parent if start < len(path) else tip]
    rigid += [joint.child for joint in path[start:first]]
    return min(rigid, key=base_rank)


def _branches(index: TreeIndex, root: str, base: str | None) -> Iterator[ChainCandidate]:
    """A candidate for each rigid body behind which nothing but fingers moves."""
    links = arm_links(index, root)
    for hub in index.subtree(root):
        if hub not in links or hub_of(index, hub, root) != hub:
            continue
        body = rigid_body(index, hub, links)
        onward = [j for link in body for j in index.below[link] if j.type is not JointType.FIXED]
        if any(joint.child in links for joint in onward):
            continue
        tip, why = _best_tip(index, hub, body)
        start = conventional_base(index, root, tip) if base is None else base
        joints = _moving(index.path(start, tip) or ())
        if joints:
            yield ChainCandidate(start, tip, _names(joints), _dof(joints), why)


def _best_tip(index: TreeIndex, hub: str, body: Sequence[str]) -> tuple[str, str]:
    def preference(link: str) -> tuple[int, bool, int]:
        return tip_rank(link), is_sensor(link), -len(index.path(hub, link) or ())

    tip = min(body, key=preference)
    if tip_rank(tip) < NO_RANK:
        return tip, "a conventional name for a tip"
    return tip, "the last link before a gripper or the end of the tree"


def _after_floating(path: Sequence[Joint]) -> int:
    """How many joints of a path to leave out so that no floating or planar one remains."""
    free = (JointType.FLOATING, JointType.PLANAR)
    return max((i + 1 for i, joint in enumerate(path) if joint.type in free), default=0)


def _moving(path: Sequence[Joint]) -> tuple[Joint, ...]:
    return tuple(joint for joint in path if joint.type.moves_on_one_axis)


def _names(joints: Sequence[Joint]) -> tuple[str, ...]:
    return tuple(joint.name for joint in joints)


def _dof(joints: Sequence[Joint]) -> int:
    return len({joint.name if joint.mimic is None else joint.mimic.joint for joint in joints})


def _shared(a: ChainCandidate, b: ChainCandidate) -> int:
    """How many joints two chains have in common at their beginning."""
    pairs = zip(a.joints, b.joints, strict=False)
    return sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], pairs))


def _without_side_branches(chains: list[ChainCandidate]) -> list[ChainCandidate]:
    """Drop the branches too short to be an arm beside a longer one, and heads."""
    arms = []
    for chain in chains:
        longer = [other for other in chains if len(other.joints) > len(chain.joints)]
        if any(len(chain.joints) - _shared(chain, other) < ARM_JOINTS for other in longer):
            continue
        arms.append(chain)
    bodies = [arm for arm in arms if not any(is_head(joint) for joint in arm.joints)]
    return bodies or arms


def _without_trunk(
    index: TreeIndex, arm: ChainCandidate, arms: Sequence[ChainCandidate]
) -> ChainCandidate | None:
    """The part of an arm behind the joints that it shares with another one."""
    shared = max((_shared(arm, other) for other in arms if other is not arm), default=0)
    if not shared:
        return None
    joints = _moving(index.path(arm.base, arm.tip) or ())
    own = joints[shared:]
    why = f"{arm.why}, from where the arms part"
    return replace(arm, base=joints[shared - 1].child, joints=_names(own), dof=_dof(own), why=why)
