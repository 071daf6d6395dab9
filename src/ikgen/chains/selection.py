"""From a tree, a base and a tip to the serial chain between them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from types import MappingProxyType

import numpy as np

from ikgen.chains.arms import ChainCandidate, candidate_chains
from ikgen.chains.chain_ends import choose_ends, not_below
from ikgen.chains.mimic import Coupling, couple
from ikgen.errors import UnknownNameError, UnsupportedJointError, UsageError
from ikgen.importers.urdf.topology import TreeIndex
from ikgen.importers.xml_document import shown_file
from ikgen.model.chain import PRISMATIC, REVOLUTE, ActuatedJoint, Chain, ChainAxis
from ikgen.model.joint_tree import Joint, JointTree, JointType, Matrix

__all__ = ["ChainCandidate", "candidate_chains", "select_chain"]

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
    `UnknownNameError` for a link or joint that is not there, `UnsupportedJointError` for a floating
    or planar joint between the two links.
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
    couplings = couple(tree, path)
    _check_locked(tree, path, couplings, locked)
    if all(coupling.value(locked) is not None for coupling in couplings.values()):
        raise UsageError(
            f"nothing moves between '{base}' and '{tip}'",
            hint="choose --base and --tip with moving joints between them, or lock fewer joints",
        )
    return _build(tree, base, tip, path, couplings, locked)


def _check_types(tree: JointTree, path: Sequence[Joint]) -> None:
    for joint in path:
        if joint.type in (JointType.FLOATING, JointType.PLANAR):
            raise UnsupportedJointError(
                f"joint '{joint.name}' between base and tip is {joint.type.value}: it has no "
                "single axis",
                file=shown_file(tree.source),
                line=joint.line,
                hint=f"choose a base below it: --base {joint.child}",
            )


def _check_locked(
    tree: JointTree,
    path: Sequence[Joint],
    couplings: Mapping[str, Coupling],
    locked: Mapping[str, float],
) -> None:
    drivers = {coupling.driver.name for coupling in couplings.values()}
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
            hint = f"joints of the chain: {', '.join(sorted(drivers))}"
        raise UsageError(f"locked joint '{name}' {message}", hint=hint)


def _build(
    tree: JointTree,
    base: str,
    tip: str,
    path: Sequence[Joint],
    couplings: Mapping[str, Coupling],
    locked: Mapping[str, float],
) -> Chain:
    drivers = _drivers(path, couplings, locked)
    axes, T_last_tip = _axes(path, couplings, drivers, locked)
    return Chain(
        robot=tree.name,
        base_link=base,
        tip_link=tip,
        joints=tuple(_actuated(driver) for driver in drivers),
        axes=axes,
        T_last_tip=T_last_tip,
        locked=tuple(sorted((name, float(value)) for name, value in locked.items())),
    )


def _axes(
    path: Sequence[Joint],
    couplings: Mapping[str, Coupling],
    drivers: Sequence[Joint],
    locked: Mapping[str, float],
) -> tuple[tuple[ChainAxis, ...], Matrix]:
    """The moving axes, and the transform (4, 4) from the last one's joint frame to the tip."""
    axes: list[ChainAxis] = []
    T = np.eye(4)  # from the previous axis' joint frame
    for joint in path:
        T = T @ joint.T_parent_child
        if not joint.type.moves_on_one_axis:
            continue
        coupling = couplings[joint.name]
        constant = coupling.value(locked)
        if constant is not None:
            T = T @ _motion(joint, constant)
            continue
        axes.append(
            ChainAxis(
                name=joint.name,
                kind=_kind(joint),
                T_prev_axis=_read_only(T),
                axis=joint.axis,
                driver=drivers.index(coupling.driver),
                multiplier=coupling.multiplier,
                offset=coupling.offset,
            )
        )
        T = np.eye(4)
    return tuple(axes), _read_only(T)


def _drivers(
    path: Sequence[Joint], couplings: Mapping[str, Coupling], locked: Mapping[str, float]
) -> list[Joint]:
    """The independent joints in the chain's order.

    A driver in the chain stands at its own place even where a joint before it mimics it; one
    outside the chain stands at the place of the first joint that mimics it.
    """
    between = {joint.name for joint in path}
    drivers: list[Joint] = []
    for name, coupling in couplings.items():
        driver = coupling.driver
        in_place = driver.name == name or driver.name not in between
        if in_place and coupling.value(locked) is None and driver not in drivers:
            drivers.append(driver)
    return drivers


def _kind(joint: Joint) -> str:
    return PRISMATIC if joint.type is JointType.PRISMATIC else REVOLUTE


def _actuated(joint: Joint) -> ActuatedJoint:
    continuous = joint.type is JointType.CONTINUOUS
    return ActuatedJoint(joint.name, _kind(joint), joint.limits, continuous)


def _motion(joint: Joint, value: float) -> Matrix:
    """The joint's motion (4, 4) at a constant value, by Rodrigues' formula."""
    T = np.eye(4)
    if joint.type is JointType.PRISMATIC:
        T[:3, 3] = joint.axis * value
        return T
    x, y, z = (float(part) for part in joint.axis)
    K = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    T[:3, :3] += math.sin(value) * K + (1.0 - math.cos(value)) * (K @ K)
    return T


def _read_only(T: Matrix) -> Matrix:
    T = T.copy()
    T.setflags(write=False)
    return T
