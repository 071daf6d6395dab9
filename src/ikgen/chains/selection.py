"""From a tree, a base and a tip to the serial chain between them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from types import MappingProxyType

from ikgen.chains.assembly import assemble
from ikgen.chains.chain_ends import choose_ends, not_below
from ikgen.chains.mimic import Coupling, couple
from ikgen.errors import UnknownNameError, UnsupportedJointError, UsageError
from ikgen.importers.urdf.topology import TreeIndex
from ikgen.importers.xml_document import shown_file
from ikgen.model.chain import MOST_AXES, Chain
from ikgen.model.joint_tree import Joint, JointTree

__all__ = ["select_chain"]

_NONE: Mapping[str, float] = MappingProxyType({})


def select_chain(
    tree: JointTree,
    base: str | None = None,
    tip: str | None = None,
    locked: Mapping[str, float] = _NONE,
) -> Chain:
    """The chain from link `base` to link `tip`; by default the one arm there is.

    `locked` holds joints at a value (rad or m): they become constants of the chain. A mimic joint
    in the chain follows its driver; where the driver lies outside the chain, it is listed among the
    chain's joints all the same, since its value moves the chain.

    Raises `UsageError` listing the candidates where the ends are not given and several arms exist,
    and where a chain is longer than can be derived, `UnknownNameError` for a link or joint that is
    not there, `UnsupportedJointError` for a floating or planar joint between the two links.
    """
    index = TreeIndex.of(tree)
    for link in (base, tip):
        if link is not None:
            index.require_link(link)
    base, tip = choose_ends(tree, index, base, tip)
    path = index.path(base, tip)
    if path is None:
        raise not_below(tree, index, base, tip)
    _check_types(tree, path)
    _check_length(path, locked)
    couplings = couple(tree, path)
    _check_locked(tree, path, couplings, locked)
    if all(coupling.value(locked) is not None for coupling in couplings.values()):
        raise UsageError(
            f"nothing moves between '{base}' and '{tip}'",
            hint="choose --base and --tip with moving joints between them, or lock fewer joints",
        )
    return assemble(tree.name, base, tip, path, couplings, locked)


def _check_types(tree: JointTree, path: Sequence[Joint]) -> None:
    for joint in path:
        if joint.type.moves_on_more_axes:
            raise UnsupportedJointError(
                f"joint '{joint.name}' between base and tip is {joint.type.value}: it has no "
                "single axis",
                file=shown_file(tree.source),
                line=joint.line,
                hint=f"choose a base below it: --base {joint.child}",
            )


def _check_length(path: Sequence[Joint], locked: Mapping[str, float]) -> None:
    moving = [j for j in path if j.type.moves_on_one_axis and j.name not in locked]
    if len(moving) > MOST_AXES:
        raise UsageError(
            f"{len(moving)} joints move between '{path[0].parent}' and '{path[-1].child}', more than "
            f"{MOST_AXES}",
            hint="choose nearer links by --base and --tip, or fix joints by --lock JOINT=VALUE",
        )


def _check_locked(
    tree: JointTree,
    path: Sequence[Joint],
    couplings: Mapping[str, Coupling],
    locked: Mapping[str, float],
) -> None:
    drivers = list(dict.fromkeys(coupling.driver.name for coupling in couplings.values()))
    types = {joint.name: joint.type for joint in tree.joints}
    between = {joint.name for joint in path}
    for name, value in locked.items():
        if name not in types:
            raise UnknownNameError("joint", name, drivers)
        if not math.isfinite(value):
            raise UsageError(f"joint '{name}' is locked at {value}", hint="give a finite value")
        if name in drivers:
            continue
        if name in couplings:
            driver = couplings[name].driver.name
            message, hint = "mimics another joint", f"lock its driver: --lock {driver}=VALUE"
        elif name in between:
            message, hint = "is fixed already", "leave the --lock out"
        else:
            message = "is not between base and tip"
            hint = f"joints of the chain: {', '.join(drivers)}"
        raise UsageError(f"locked joint '{name}' {message}", hint=hint)
