"""The chains of a tree that someone may want solved: its arms, without their grippers.

A tree does not say where its arms begin and end. With fingers, wheels and rotors taken off
(`grippers`), its long branches are the arms; short side branches (the parallel rods of a palletiser,
a camera that pans) and heads are none. The ends are chosen by conventional names among the links
rigidly attached there.
"""

from __future__ import annotations

import shlex
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import takewhile

from ikgen.chains.grippers import ARM_JOINTS, ArmLinks, arm_links
from ikgen.chains.link_names import NO_RANK, base_rank, is_finger_part, is_head, is_sensor, tip_rank
from ikgen.chains.rigid_bodies import RigidBodies
from ikgen.importers.urdf.topology import TreeIndex
from ikgen.model.counted import listed
from ikgen.model.joint_tree import Joint, JointTree, JointType

__all__ = ["ChainCandidate", "candidate_chains", "conventional_base"]


@dataclass(frozen=True, slots=True)
class ChainCandidate:
    """One chain of a tree: its ends, its moving joints from base to tip, and why it was chosen.

    `dof` counts independent joints: a mimic joint follows its driver. `left_out` says which joint behind
    the tip is taken for a gripper's where it may be the arm's, and which lie above a joint that floats or
    moves in a plane ("": none). `followers`: what those of the joints follow that follow another one.
    `other_tips` are the links fixed to the tip, nearest to the joint first: the same joints place them.
    """

    base: str
    tip: str
    joints: tuple[str, ...]
    dof: int
    why: str
    left_out: str = ""
    followers: Mapping[str, str] = field(default_factory=dict)
    other_tips: tuple[str, ...] = ()

    @property
    def words(self) -> str:
        """The joints, those marked that follow another one."""
        follows = {name: f" (follows {driver})" for name, driver in self.followers.items()}
        return ", ".join(f"{name}{follows.get(name, '')}" for name in self.joints)


def candidate_chains(tree: JointTree, base: str | None = None) -> tuple[ChainCandidate, ...]:
    """The arms of a tree, longest first; those that start at `base` where it is given.

    Arms that share a trunk (a torso) are listed with the trunk and again from where they part.
    """
    index = TreeIndex.of(tree)
    root = tree.root_link if base is None else base
    index.require_link(root)
    arms = _without_side_branches(list(_branches(index, root, base)))
    if base is None:
        through = Counter(joint for arm in arms for joint in arm.joints)
        arms += [part for arm in arms if (part := _without_trunk(index, arm, through)) is not None]
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
    """A candidate for each rigid body behind which nothing but fingers and wheels moves."""
    bodies = RigidBodies.of(index, root)
    arms = arm_links(index, bodies)
    for hub, body in bodies.links.items():
        if hub not in arms.links or any(j.child in arms.links for j in bodies.exits[hub]):
            continue
        tip, why = _best_tip(bodies, body, arms)
        start = conventional_base(index, root, tip) if base is None else base
        joints = _moving(index.path(start, tip) or ())
        if joints:
            above = _above_floating(index.path(root, tip) or ()) if base is None else ""
            left_out = "; ".join(filter(None, (_left_out(arms.doubtful.get(hub, ())), above)))
            follow = _followers(joints)
            how = (_names(joints), _dof(joints), why, left_out, follow)
            yield ChainCandidate(start, tip, *how, tuple(link for link in body if link != tip))


def _left_out(joints: Sequence[Joint]) -> str:
    if not joints:
        return ""
    names = ", ".join(f"'{joint.name}'" for joint in joints)
    first = joints[0]
    if len(joints) == 1:
        return (
            f"{names} is left out as a gripper's joint: --tip {shlex.quote(first.child)} keeps it"
        )
    tip = shlex.quote(first.child)
    return f"{names} are left out as a gripper's joints: --tip {tip} keeps '{first.name}'"


def _above_floating(path: Sequence[Joint]) -> str:
    """That joints of a path move above one that no chain goes through."""
    end = _after_floating(path)
    above = _names(_moving(path[:end]))
    if not above:
        return ""
    last = path[end - 1]
    names = listed([f"'{name}'" for name in above])
    return (
        f"{names} {'lies' if len(above) == 1 else 'lie'} above the {last.type.value} joint '{last.name}', "
        f"through which no chain goes: left out; --tip {shlex.quote(last.parent)} ends one before it"
    )


def _best_tip(bodies: RigidBodies, body: Sequence[str], arms: ArmLinks) -> tuple[str, str]:
    def preference(link: str) -> tuple[int, bool, int]:
        aside = is_sensor(link) or link in arms.held_fingers or is_finger_part(link)
        return tip_rank(link), aside, -bodies.depth[link]

    tip = min(body, key=preference)
    if tip_rank(tip) < NO_RANK:
        return tip, "a conventional name for a tip"
    return tip, "the last link before a gripper or the end of the tree"


def _after_floating(path: Sequence[Joint]) -> int:
    """How many joints of a path to leave out so that no floating or planar one remains."""
    return max((i + 1 for i, joint in enumerate(path) if joint.type.moves_on_more_axes), default=0)


def _moving(path: Sequence[Joint]) -> tuple[Joint, ...]:
    return tuple(joint for joint in path if joint.type.moves_on_one_axis)


def _names(joints: Sequence[Joint]) -> tuple[str, ...]:
    return tuple(joint.name for joint in joints)


def _followers(joints: Sequence[Joint]) -> dict[str, str]:
    return {joint.name: joint.mimic.joint for joint in joints if joint.mimic is not None}


def _dof(joints: Sequence[Joint]) -> int:
    return len({joint.name if joint.mimic is None else joint.mimic.joint for joint in joints})


def _without_side_branches(chains: list[ChainCandidate]) -> list[ChainCandidate]:
    """Drop the branches too short to be an arm beside a longer one, and heads."""
    longest: dict[str, int] = {}  # of the chains through a joint; "" stands for where all begin
    for chain in chains:
        for joint in ("", *chain.joints):
            longest[joint] = max(longest.get(joint, 0), len(chain.joints))
    arms = []
    for chain in chains:
        # The last joint before the part that would be an arm of its own.
        fork = ("", *chain.joints)[max(len(chain.joints) - ARM_JOINTS + 1, 0)]
        if longest[fork] <= len(chain.joints):
            arms.append(chain)
    bodies = [arm for arm in arms if not any(is_head(joint) for joint in arm.joints)]
    return bodies or arms


def _without_trunk(
    index: TreeIndex, arm: ChainCandidate, through: Counter[str]
) -> ChainCandidate | None:
    """The part of an arm behind the joints that it shares with another one; `through` counts the
    arms of each joint."""
    shared = sum(1 for _ in takewhile(lambda joint: through[joint] > 1, arm.joints))
    if not shared:
        return None
    joints = _moving(index.path(arm.base, arm.tip) or ())
    own = joints[shared:]
    why = f"{arm.why}, behind '{joints[shared - 1].name}', the last joint that arms share"
    start = joints[shared - 1].child
    return replace(
        arm, base=start, joints=_names(own), dof=_dof(own), why=why, followers=_followers(own)
    )
