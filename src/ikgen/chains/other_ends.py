"""Ends of moving branches that are taken for no arm: fingers beside a longer one, side branches, heads."""

from __future__ import annotations

from collections.abc import Sequence

from ikgen.chains.arms import ChainCandidate
from ikgen.chains.link_names import is_wheel
from ikgen.chains.rigid_bodies import RigidBodies
from ikgen.importers.urdf.topology import TreeIndex
from ikgen.model.joint_tree import JointTree

__all__ = ["other_ends"]


def other_ends(
    tree: JointTree, chains: Sequence[ChainCandidate], base: str | None = None
) -> tuple[str, ...]:
    """The last link of each moving branch at and below `base` that none of the chains goes along, in the
    file's order; what hangs on a chain's tip is its gripper, and wheels are no ends."""
    index = TreeIndex.of(tree)
    bodies = RigidBodies.of(index, tree.root_link if base is None else base)
    tips = {bodies.hub[chain.tip] for chain in chains if chain.tip in bodies.hub}
    ends = []
    for hub, links in bodies.links.items():
        path = index.path(bodies.root, hub) or ()
        behind = any(bodies.hub[joint.child] in tips for joint in path)
        if bodies.exits[hub] or not path or behind or hub in tips or hub == bodies.root:
            continue
        if not is_wheel(path[-1].name, hub):
            ends.append(max(links, key=bodies.depth.__getitem__))
    return tuple(ends)
