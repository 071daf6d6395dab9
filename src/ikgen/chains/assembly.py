"""A path of joints made into a chain: moving axes, and the constant transforms between them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ikgen.chains.merged_axes import merged_axes
from ikgen.chains.mimic import Coupling
from ikgen.kinematics.fixed_order import product
from ikgen.kinematics.rigid import axis_motion, read_only
from ikgen.model.arrays import Array
from ikgen.model.chain import PRISMATIC, REVOLUTE, ActuatedJoint, Chain, ChainAxis
from ikgen.model.joint_tree import Joint, JointType

__all__ = ["assemble"]


def assemble(
    robot: str,
    base: str,
    tip: str,
    path: Sequence[Joint],
    couplings: Mapping[str, Coupling],
    locked: Mapping[str, float],
) -> Chain:
    """The chain of a path of joints; `couplings` as `couple` gives them, `locked` in rad or m."""
    drivers = _drivers(path, couplings, locked)
    file_axes, T_last_tip = _axes(path, couplings, drivers, locked)
    joints = tuple(_actuated(driver) for driver in drivers)
    spans = [joint.limits.upper - joint.limits.lower for joint in joints]
    axes, T_last_tip = merged_axes(file_axes, T_last_tip, spans)
    return Chain(
        robot=robot,
        base_link=base,
        tip_link=tip,
        joints=joints,
        axes=axes,
        T_last_tip=T_last_tip,
        locked=tuple(sorted((name, float(value)) for name, value in locked.items())),
        file_axes=file_axes if len(axes) < len(file_axes) else (),
    )


def _axes(
    path: Sequence[Joint],
    couplings: Mapping[str, Coupling],
    drivers: Sequence[Joint],
    locked: Mapping[str, float],
) -> tuple[tuple[ChainAxis, ...], Array]:
    """The moving axes, and the transform (4, 4) from the last one's joint frame to the tip."""
    axes: list[ChainAxis] = []
    T = np.eye(4)  # from the previous axis' joint frame
    for joint in path:
        T = product(T, joint.T_parent_child)
        if not joint.type.moves_on_one_axis:
            continue
        coupling = couplings[joint.name]
        constant = coupling.value(locked)
        if constant is not None:
            revolute = joint.type is not JointType.PRISMATIC
            T = product(T, axis_motion(revolute, joint.axis, constant))
            continue
        axes.append(
            ChainAxis(
                name=joint.name,
                kind=_kind(joint),
                T_prev_axis=read_only(T),
                axis=joint.axis,
                driver=drivers.index(coupling.driver),
                multiplier=coupling.multiplier,
                offset=coupling.offset,
            )
        )
        T = np.eye(4)
    return tuple(axes), read_only(T)


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
