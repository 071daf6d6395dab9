"""A tree seen as rigid bodies: links that fixed joints hold together, and what moves between them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from ikgen.importers.urdf.topology import TreeIndex
from ikgen.model.joint_tree import Joint, JointType

__all__ = ["RigidBodies"]


@dataclass(frozen=True, slots=True)
class RigidBodies:
    """The rigid bodies at and below a link `root`, each named by its link nearest to root, its hub.

    `hub`: the body of each link, parents first. `links`: each body's links, parents first. `exits`:
    the joints that leave each body and are not fixed. `depth`: joints of any type above a link.
    `moving_above`: joints with one axis above it. `moving_below`: the most of them in a row below it.
    All are counted from root. `place`: the number of each link with those that hang on it following;
    `reach`: for each joint, above root too, the first and the last number below it.
    """

    root: str
    hub: Mapping[str, str]
    links: Mapping[str, tuple[str, ...]]
    exits: Mapping[str, tuple[Joint, ...]]
    depth: Mapping[str, int]
    moving_above: Mapping[str, int]
    moving_below: Mapping[str, int]
    place: Mapping[str, int]
    reach: Mapping[str, tuple[int, int]]

    def hangs_on(self, link: str, joint: str) -> bool:
        """Whether a joint lies between a link of the bodies and the tree's root."""
        first, last = self.reach.get(joint, (1, 0))
        return first <= self.place[link] <= last

    def carries(self, joint: str, other: str) -> bool:
        """Whether a joint moves another one."""
        first, last = self.reach.get(joint, (1, 0))
        return joint != other and first <= self.reach.get(other, (0, 0))[0] <= last

    @staticmethod
    def of(index: TreeIndex, root: str) -> RigidBodies:
        """The bodies of the tree below a link."""
        order = tuple(index.subtree(root))
        hub, depth, above = {root: root}, {root: 0}, {root: 0}
        links: dict[str, list[str]] = {}
        exits: dict[str, list[Joint]] = {}
        for link in order:
            links.setdefault(hub[link], []).append(link)
            leaving = exits.setdefault(hub[link], [])
            for joint in index.below[link]:
                fixed = joint.type is JointType.FIXED
                hub[joint.child] = hub[link] if fixed else joint.child
                depth[joint.child] = depth[link] + 1
                above[joint.child] = above[link] + joint.type.moves_on_one_axis
                if not fixed:
                    leaving.append(joint)
        return RigidBodies(
            root=root,
            hub=hub,
            links={name: tuple(found) for name, found in links.items()},
            exits={name: tuple(found) for name, found in exits.items()},
            depth=depth,
            moving_above=above,
            moving_below=_moving_below(index, order),
            place={link: i for i, link in enumerate(order)},
            reach=_reach(index, order),
        )


def _moving_below(index: TreeIndex, order: tuple[str, ...]) -> dict[str, int]:
    below: dict[str, int] = {}
    for link in reversed(order):
        runs = [below[j.child] + j.type.moves_on_one_axis for j in index.below[link]]
        below[link] = max(runs, default=0)
    return below


def _reach(index: TreeIndex, order: tuple[str, ...]) -> dict[str, tuple[int, int]]:
    last: dict[str, int] = {}
    reach: dict[str, tuple[int, int]] = {}
    for i, link in reversed(list(enumerate(order))):
        last[link] = max((last[j.child] for j in index.below[link]), default=i)
        if i:
            reach[index.above[link].name] = (i, last[link])
    link = order[0]
    while link in index.above:
        reach[index.above[link].name] = (0, len(order))
        link = index.above[link].parent
    return reach
