"""Oracles: forward kinematics of an original description, a URDF file or a DH table, by
Pinocchio."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np

from ikgen.errors import BadDescriptionError, UnknownNameError
from ikgen.model.dh import DHChain
from ikgen.model.joint_tree import JointTree
from ikgen.verify.pinocchio_model import Oracle, load_pinocchio
from ikgen.verify.urdf_text import JOINT_PREFIX, KinematicText, read_kinematic_text

__all__ = ["Oracle", "PinocchioOracle", "oracle_from_dh"]

_SHALLOW = 1000  # joints that any stack holds
_STACK = 16 * 1024  # bytes a joint: a quarter was enough


def _resolve(
    name: str, text: KinematicText, actuated: Sequence[str], locked: Mapping[str, float]
) -> tuple[int | None, float, float]:
    """What sets joint `name`: (index of the actuated joint or None, multiplier, offset)."""
    multiplier, offset = 1.0, 0.0
    for _ in range(len(text.mimic) + 1):
        if name in actuated:
            return list(actuated).index(name), multiplier, offset
        if name in locked or name not in text.mimic:
            return None, 0.0, offset + multiplier * locked.get(name, 0.0)
        name, factor, shift = text.mimic[name]
        multiplier, offset = multiplier * factor, offset + multiplier * shift
    raise BadDescriptionError(
        f"joint {name} mimics itself in a circle", hint="let one of them follow no other"
    )


class PinocchioOracle(Oracle):
    """The oracle of a URDF or xacro file, built from its expanded text `tree.source.text` alone.

    `joint_names`: the actuated joints, base to tip; `locked`: values (rad or m) of joints held
    still. Mimic joints follow the file; all others stand at zero. Raises `UnknownNameError` for a
    link or joint that the file lacks, `BadDescriptionError` where Pinocchio cannot read it.
    """

    def __init__(
        self,
        tree: JointTree,
        base_link: str,
        tip_link: str,
        joint_names: Sequence[str],
        locked: Mapping[str, float] | None = None,
    ) -> None:
        pin, text = load_pinocchio(), read_kinematic_text(tree.source.text, base_link, tip_link)
        try:
            model = _with_stack(lambda: pin.buildModelFromXML(text.xml), text.xml.count("<joint"))
        except (ValueError, RuntimeError) as error:
            raise BadDescriptionError(
                f"Pinocchio cannot read the description: {error}",
                file=str(tree.source.path),
                hint="mend what it names; --no-verify writes code that was not checked",
            ) from error
        for joint in [*joint_names, *(locked or {})]:
            if joint not in text.ranges:
                raise UnknownNameError("joint", joint, text.ranges)
        frames = tuple(_link_frame(pin, model, link) for link in (base_link, tip_link))
        model, wiring = _reduce(pin, model, frames, text, joint_names, locked or {})
        base, tip = (_link_frame(pin, model, link) for link in (base_link, tip_link))
        mimicked = {driver for driver, _, _ in text.mimic.values()}
        ranges = [(np.nan, np.nan) if n in mimicked else text.ranges[n] for n in joint_names]
        bounds = np.array(ranges, dtype=float).reshape(-1, 2)
        notes = tuple(f"not given to Pinocchio: {note}" for note in text.notes)
        super().__init__(
            model, (base, tip), (base_link, tip_link), joint_names, wiring,
            (bounds[:, 0], bounds[:, 1]), notes,
        )  # fmt: skip


def _with_stack(build: Callable[[], Any], joints: int) -> Any:
    """What `build` gives, with the stack that reading so many joints in a row takes: Pinocchio's reader
    calls itself for each."""
    if joints < _SHALLOW:
        return build()
    before = threading.stack_size(joints * _STACK)
    try:
        with ThreadPoolExecutor(1) as pool:
            return pool.submit(build).result()
    finally:
        threading.stack_size(before)


def _link_frame(pin: Any, model: Any, link: str) -> int:
    bodies = [f.name for f in model.frames if f.type == pin.FrameType.BODY]
    if link not in bodies:
        raise UnknownNameError("link", link, bodies)
    return int(model.getFrameId(link, pin.FrameType.BODY))


def _reduce(
    pin: Any,
    model: Any,
    frames: tuple[int, ...],
    text: KinematicText,
    joint_names: Sequence[str],
    locked: Mapping[str, float],
) -> tuple[Any, dict[str, tuple[int, float, float]]]:
    """The model of the moving joints between the two frames alone, and what drives each of them."""
    supports = [set(model.supports[model.frames[f].parentJoint]) - {0} for f in frames]
    path = supports[0] ^ supports[1]
    wiring, fixed, reference = {}, [], pin.neutral(model)
    for i in range(1, model.njoints):
        name, joint = model.names[i], model.joints[i]
        plain = name.removeprefix(JOINT_PREFIX)
        driver, multiplier, offset = _resolve(plain, text, joint_names, locked)
        if i in path and driver is not None:
            wiring[name] = (driver, multiplier, offset)
            continue
        fixed.append(i)
        if joint.nv == 1:
            angle = [np.cos(offset), np.sin(offset)]
            reference[joint.idx_q : joint.idx_q + joint.nq] = angle if joint.nq == 2 else offset
    return pin.buildReducedModel(model, fixed, reference), wiring


def oracle_from_dh(dh: DHChain) -> Oracle:
    """The oracle of a DH table: of `dh.file_frames`, the table's own numbers."""
    pin = load_pinocchio()
    model, parent = pin.Model(), 0
    base = model.addFrame(pin.Frame("base", 0, 0, pin.SE3.Identity(), pin.FrameType.BODY))
    wiring = {}
    for i, row in enumerate(dh.rows):
        joint = pin.JointModelRZ() if row.revolute else pin.JointModelPZ()
        name = f"axis_{i + 1}"
        parent = model.addJoint(parent, joint, pin.SE3(np.array(dh.file_frames[i])), name)
        wiring[name] = (row.driver, row.scale, row.offset.value)
    end = pin.Frame("tip", parent, base, pin.SE3(np.array(dh.file_frames[-1])), pin.FrameType.BODY)
    tip = model.addFrame(end)
    names = [joint.name for joint in dh.joints]
    lower = np.array([joint.limits.lower for joint in dh.joints])
    upper = np.array([joint.limits.upper for joint in dh.joints])
    links = dh.base_link, dh.tip_link
    return Oracle(model, (base, tip), links, names, wiring, (lower, upper))
