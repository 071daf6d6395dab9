"""How the links of a description hang together: its root, and the faults that make it no tree."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from ikgen.errors import BadDescriptionError, UnknownNameError
from ikgen.model.joint_tree import Joint, JointTree

__all__ = ["TreeIndex", "check_joints", "find_roots"]

_LONGEST_SHOWN = 12
"""How many joints of a cycle a message names."""


@dataclass(frozen=True, slots=True)
class TreeIndex:
    """A tree's joints by the link they hold (`above`) and by the link they leave (`below`)."""

    links: tuple[str, ...]
    above: Mapping[str, Joint]
    below: Mapping[str, tuple[Joint, ...]]

    @staticmethod
    def of(tree: JointTree) -> TreeIndex:
        """Index a tree."""
        below: dict[str, list[Joint]] = {link: [] for link in tree.links}
        for joint in tree.joints:
            below[joint.parent].append(joint)
        return TreeIndex(
            links=tree.links,
            above={joint.child: joint for joint in tree.joints},
            below={link: tuple(joints) for link, joints in below.items()},
        )

    def path(self, base: str, tip: str) -> tuple[Joint, ...] | None:
        """The joints from base down to tip, in this order; None where tip does not hang on base."""
        joints: list[Joint] = []
        link = tip
        while link != base:
            joint = self.above.get(link)
            if joint is None:
                return None
            joints.append(joint)
            link = joint.parent
        return tuple(reversed(joints))

    def root_of(self, link: str) -> str:
        """The link on which everything above `link` hangs."""
        while link in self.above:
            link = self.above[link].parent
        return link

    def subtree(self, root: str) -> Iterator[str]:
        """The link `root` and all that hang on it, parents first."""
        waiting = [root]
        while waiting:
            link = waiting.pop()
            yield link
            waiting.extend(joint.child for joint in reversed(self.below[link]))

    def require_link(self, link: str) -> None:
        """Raise `UnknownNameError` unless there is a link of that name."""
        if link not in self.below:
            raise UnknownNameError("link", link, self.links)


def check_joints(links: Sequence[str], joints: Sequence[Joint], file: str) -> None:
    """Raise `BadDescriptionError` for undefined links, a link with two parents, or a cycle."""
    known = set(links)
    above: dict[str, Joint] = {}
    for joint in joints:
        for role, link in (("parent", joint.parent), ("child", joint.child)):
            if link not in known:
                raise BadDescriptionError(
                    f"joint '{joint.name}' names the {role} link '{link}', which is not defined",
                    file=file,
                    line=joint.line,
                    hint=f"define it, or remove the joint, as ROS refuses such a file too; "
                    f"{UnknownNameError('link', link, links).hint}",
                )
        if joint.child in above:
            first = above[joint.child]
            raise BadDescriptionError(
                f"link '{joint.child}' has two parents: joint '{first.name}' (line {first.line}) "
                f"and joint '{joint.name}'",
                file=file,
                line=joint.line,
                hint="a URDF is a tree: remove one of the two joints; ikgen solves serial chains, not "
                "mechanisms with closed loops as a delta robot",
            )
        above[joint.child] = joint
    _check_acyclic(joints, above, file)


def _check_acyclic(joints: Sequence[Joint], above: Mapping[str, Joint], file: str) -> None:
    grounded: set[str] = set()
    for start in joints:
        trail: list[Joint] = []
        seen: set[str] = set()
        link = start.child
        while link in above and link not in grounded:
            if link in seen:
                loop = trail[next(i for i, joint in enumerate(trail) if joint.child == link) :]
                names = _shown([joint.name for joint in reversed(loop)])
                raise BadDescriptionError(
                    f"the joints form a cycle: {names}",
                    file=file,
                    line=loop[0].line,
                    hint="a URDF is a tree: remove the joint that closes the loop",
                )
            seen.add(link)
            trail.append(above[link])
            link = above[link].parent
        grounded.update(seen)


def _shown(names: Sequence[str]) -> str:
    if len(names) <= _LONGEST_SHOWN:
        return " -> ".join(names)
    left_out = len(names) - _LONGEST_SHOWN
    return " -> ".join([*names[: _LONGEST_SHOWN - 1], f"... {left_out} more ...", names[-1]])


def find_roots(links: Sequence[str], joints: Sequence[Joint]) -> tuple[tuple[str, int], ...]:
    """The links without a parent and how many links hang on each, the largest first."""
    parent = {joint.child: joint.parent for joint in joints}
    top = {link: link for link in links if link not in parent}
    sizes = dict.fromkeys(top, 0)
    for link in links:
        trail = []
        while link not in top:
            trail.append(link)
            link = parent[link]
        top.update(dict.fromkeys(trail, top[link]))
        sizes[top[link]] += 1
    return tuple(sorted(sizes.items(), key=lambda item: -item[1]))
