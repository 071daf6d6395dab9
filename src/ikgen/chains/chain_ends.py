"""The two ends of a chain: chosen where they are not given, explained where they do not fit."""

from __future__ import annotations

import shlex
from collections.abc import Iterable

from ikgen.chains.arms import ChainCandidate, candidate_chains, conventional_base
from ikgen.chains.other_ends import other_ends
from ikgen.errors import UsageError
from ikgen.importers.urdf.topology import TreeIndex
from ikgen.model.counted import counted, listed
from ikgen.model.joint_tree import Joint, JointTree

__all__ = ["choose_ends", "not_below"]

_MOST_SHOWN = 20


def choose_ends(
    tree: JointTree, index: TreeIndex, base: str | None, tip: str | None
) -> tuple[str, str]:
    """Base and tip, the missing ones by convention.

    Raises `UsageError` with the options to type where the tree has several arms, or none.
    """
    if tip is not None:
        return base or conventional_base(index, index.root_of(tip), tip), tip
    candidates = candidate_chains(tree, base)
    if len(candidates) == 1:
        return candidates[0].base, candidates[0].tip
    if not candidates:
        raise _no_arm(tree, index, base)
    options = "\n".join(f"  {_options(candidate)}" for candidate in candidates[:_MOST_SHOWN])
    if len(candidates) > _MOST_SHOWN:
        options += f"\n  ... and {len(candidates) - _MOST_SHOWN} more"
    others = other_ends(tree, candidates, base)
    if others:
        fingers = f"taken for fingers or side branches: {listed(others)}"
        options += f"\n{fingers}; --tip LINK takes one for an arm"
    raise UsageError(
        f"robot '{tree.name}' has several chains; choose one", hint=f"give one of:\n{options}"
    )


def _no_arm(tree: JointTree, index: TreeIndex, base: str | None) -> UsageError:
    root = tree.root_link if base is None else base
    below = [joint for link in index.subtree(root) for joint in index.below[link]]
    moving = [joint.name for joint in below if joint.type.moves_on_one_axis]
    where = f"below '{base}'" if base is not None else f"in robot '{tree.name}'"
    if not moving:
        return UsageError(f"no joint moves {where}{_unread(below)}", hint=_elsewhere(tree))
    return UsageError(
        f"no arm {where}: only fingers, wheels or rotors move there ({moving[0]}, ...)",
        hint="choose the links of a chain by --base and --tip",
    )


def _elsewhere(tree: JointTree) -> str:
    """The way out where no joint moves below the base: another one, where some joint of the file moves."""
    if any(joint.type.moves_on_one_axis for joint in tree.joints):
        return "choose other links by --base and --tip"
    if not tree.joints:
        return "the file has no joints: check that it is complete"
    turning = "revolute, continuous or prismatic"
    return (
        f"none of the file's joints is {turning}: check their types, and that the file is complete"
    )


def _unread(below: Iterable[Joint]) -> str:
    """In words, the joints that move on more axes than one; "" for none."""
    free = [one for one in below if one.type.moves_on_more_axes]
    if not free:
        return ""
    return f" on one axis: '{free[0].name}' is {free[0].type.value}, which no chain can be solved through"


def _options(chain: ChainCandidate) -> str:
    ends = f"--base {shlex.quote(chain.base)} --tip {shlex.quote(chain.tip)}"
    left_out = f"; {chain.left_out}" if chain.left_out else ""
    return f"{ends}   ({counted(chain.dof, 'joint')}: {chain.words}{left_out})"


def not_below(tree: JointTree, index: TreeIndex, base: str, tip: str) -> UsageError:
    """The error for a tip that does not hang on the base, with the links that would do."""
    if index.path(tip, base) is not None:
        hint = (
            f"'{base}' hangs on '{tip}': exchange --base and --tip; poses are the inverse ones then"
        )
    else:
        link = base
        while index.path(link, tip) is None and link in index.above:
            link = index.above[link].parent
        above = index.path(link, tip) is not None
        hint = f"'{link}' is above both: --base {link}" if above else "they are in separate trees"
    return UsageError(f"link '{tip}' is not below link '{base}' in robot '{tree.name}'", hint=hint)
