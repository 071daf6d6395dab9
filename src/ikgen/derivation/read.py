"""Read a description: the file, the chain that is meant, and the chain in DH form."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from ikgen.derivation.pinned_joints import pinned_in_chain, with_pinned
from ikgen.emit.derivation import Reading
from ikgen.errors import ArgumentError, BadDescriptionError, UsageError
from ikgen.model.chain import PRISMATIC
from ikgen.model.joint_tree import Joint
from ikgen.model.joint_value import JointValue, kind_and_units, range_text, value_text
from ikgen.model.module_name import identifier
from ikgen.model.oddity import Oddity, OddityKind

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from ikgen.model.chain import ActuatedJoint, Chain
    from ikgen.model.dh import DHChain
    from ikgen.model.joint_tree import JointTree
    from ikgen.records.request import Request

__all__ = ["arm_name", "default_name", "has_arm_angle", "read", "read_tree"]


def read(request: Request, tree: JointTree | None = None) -> Reading:
    """Read the file, choose the chain and convert it to modified DH form. `tree` is the file's where it was
    read before."""
    _check_held_once(request)
    reading = _with_motors(_with_relations(_read(request, tree), request), request)
    _check_units(request, reading.dh.held_inputs)
    if len(reading.dh.free_indices) == reading.dh.dof:
        raise UsageError(
            "every joint is held: nothing is left to solve for", hint="hold fewer by --free"
        )
    return _with_elbow(reading) if reading.dh.arm_angle else reading


def _check_held_once(request: Request) -> None:
    """Raises `UsageError` for a joint that is to be held and locked."""
    for joint in request.free:
        if joint in request.lock:
            raise UsageError(
                f"joint '{joint}' is both held (free) and locked (lock)",
                hint="free keeps it an argument of solve, lock fixes it for good: leave one out",
            )


def _with_relations(reading: Reading, request: Request) -> Reading:
    """With the relations between joints, and the names of joints that those of several sources need."""
    from ikgen.chains.several_sources import parts

    asked = (f"{joint}={x}" for joint, x in request.couple.items() if joint not in request.motors)
    behind = tuple(parts(request.sums).keys() - request.sums.keys())
    return replace(reading, relations=(*asked, *reading.coupled), parts=behind)


def _with_motors(reading: Reading, request: Request) -> Reading:
    """With the transmission between motors and joints, where the request has one."""
    if not request.motors:
        return reading
    from ikgen.kinematics.motor_matrix import motor_matrix

    transmission = motor_matrix(reading.dh, request.motors)
    return replace(reading, dh=replace(reading.dh, transmission=transmission))


def _with_elbow(reading: Reading) -> Reading:
    """With rows that have an arm angle: those of the file, or of geometry nearby. Raises UsageError
    for an arm that has none."""
    from ikgen.kinematics.elbow_geometry import elbow_geometry

    found = _elbow_nearby(reading)
    elbow_geometry(found.dh)
    return found


def _elbow_nearby(reading: Reading) -> Reading:
    """With rows of geometry nearby where those alone have an arm angle."""
    from ikgen.derivation.held_joints import nearby
    from ikgen.kinematics.elbow_geometry import without_arm_angle

    near = nearby(reading) if without_arm_angle(reading.dh) else None
    return reading if near is None or without_arm_angle(near) else replace(reading, dh=near)


def has_arm_angle(reading: Reading) -> bool:
    """Whether `--free arm-angle` can be asked for: no joint is held, and these rows or those nearby do."""
    from ikgen.kinematics.elbow_geometry import without_arm_angle

    return not reading.dh.free and not without_arm_angle(_elbow_nearby(reading).dh)


def _read(request: Request, tree: JointTree | None) -> Reading:
    free = tuple(request.free)
    if request.table:
        return _with_offsets(_read_table(request, free), request)
    from ikgen.chains.selection import select_chain
    from ikgen.importers.calibration import calibrated_tree, is_offsets
    from ikgen.kinematics.calibrated import calibrated_dh
    from ikgen.kinematics.modified_dh import to_dh

    tree = _with_left_out(tree or read_tree(request), request)
    _check_units(request, tree.joints)
    _check_locks(request, tree.joints)
    asked, request = request, pinned_in_chain(request, tree)
    tree, chain, coupled = _coupled_chain(request, tree)
    tree = _of_chain(tree, chain, asked)
    reading = Reading(tree.source, tree, chain, to_dh(chain, free=free), coupled)
    if request.calibration is None or is_offsets(request.calibration):
        return _with_offsets(reading, request)
    own = calibrated_tree(tree, request.calibration)
    calibrated = select_chain(own, chain.base_link, chain.tip_link, dict(request.lock))
    dh = calibrated_dh(reading.dh, calibrated)
    found = Reading(own.source, own, calibrated, dh, coupled)
    return _told(found, request.calibration, reading.dh)


def _of_chain(tree: JointTree, chain: Chain, request: Request) -> JointTree:
    """Without what was odd about joints that do not move the chain, or that is why the request locks some,
    and with what is of those that do."""
    from ikgen.chains.follower_limits import beyond_own_limits
    from ikgen.importers.urdf.topology import TreeIndex

    between = TreeIndex.of(tree).path(chain.base_link, chain.tip_link) or ()
    near = {joint.name for joint in between} | {joint.name for joint in chain.joints}
    others = {joint.name for joint in tree.joints} - near
    kept = []
    for one in tree.source.warnings:
        settled = one.kind is OddityKind.LOCKABLE and one.joint in request.lock
        if not settled and one.joint not in others:
            kept.append(one)
    beyond = map(Oddity, beyond_own_limits(tree, chain, between))
    warnings = (*kept, *beyond)
    return replace(tree, source=replace(tree.source, warnings=warnings))


def _with_left_out(tree: JointTree, request: Request) -> JointTree:
    """With a word on the joint that the chosen chain leaves out where it may be the arm's."""
    from ikgen.chains.arms import candidate_chains

    if request.tip is not None:
        return tree
    words = filter(None, (arm.left_out for arm in candidate_chains(tree, request.base)))
    warnings = (*tree.source.warnings, *map(Oddity, words))
    return replace(tree, source=replace(tree.source, warnings=warnings))


def _told(reading: Reading, path: Path, model: DHChain) -> Reading:
    """The calibrated reading with what there is to tell of its file beside the model's rows."""
    from ikgen.kinematics.calibrated import calibration_of

    found, source = calibration_of(path, model, reading.dh), reading.source
    source = replace(source, warnings=(*source.warnings, *found.warnings))
    return replace(reading, source=source, calibration=found)


def _coupled_chain(request: Request, tree: JointTree) -> tuple[JointTree, Chain, tuple[str, ...]]:
    """The tree with the relations between its joints, the chain that is meant, and the relations that were
    chosen: the stages of a telescope that are told nothing else take equal shares, unless one is held."""
    from ikgen.chains.related_joints import equal_shares, related_tree
    from ikgen.chains.selection import select_chain
    from ikgen.chains.several_sources import parted_tree, parts

    locked = dict(request.lock)
    chain = select_chain(tree, request.base, request.tip, locked)
    followed = {joint: one.joint for joint, one in request.relations.items()}
    relations = request.relations | parts(request.sums)
    several = (request.sums | request.motors).values()
    told = {*request.couple, *(name for one in several for name, _ in one.terms)}
    stages = equal_shares(chain, request.free, told)
    if not relations and not stages:
        return tree, chain, ()
    parted = parted_tree(tree, request.sums, locked, followed)
    tree = related_tree(parted, {**stages, **relations})
    words = tuple(f"{joint}={stage.words}" for joint, stage in stages.items())
    if stages:
        note = f"stages of a telescope take equal shares: --couple {' --couple '.join(words)}"
        warnings = (*tree.source.warnings, Oddity(note))
        tree = replace(tree, source=replace(tree.source, warnings=warnings))
    return tree, select_chain(tree, chain.base_link, chain.tip_link, locked), words


def _with_offsets(reading: Reading, request: Request) -> Reading:
    """The reading with the offsets of DH rows, where the request has some: its chain is then that of the
    rows alone."""
    path = request.calibration
    if path is None:
        return reading
    from ikgen.importers.calibration import calibrated_source, is_offsets, row_offsets
    from ikgen.kinematics.calibrated import offset_dh

    if not is_offsets(path):
        raise UsageError(
            f"--calibration {path}: a DH table takes offsets of its rows",
            hint="write [[joints]] with alpha, a, d, theta in a .toml file",
        )
    table = reading.source.text if request.table else ""
    dh = offset_dh(reading.dh, row_offsets(path, len(reading.dh.rows), table))
    return _told(Reading(calibrated_source(reading.source, path), None, None, dh), path, reading.dh)


def read_tree(request: Request) -> JointTree:
    """All links and joints of the request's file."""
    from ikgen.importers import argument_hint, load_tree

    try:
        return load_tree(
            request.robot,
            arguments=request.args,
            package_paths=request.package_paths,
            trust=request.trust,
        )
    except BadDescriptionError as error:
        words = argument_hint(request.robot, request.args, request.package_paths)
        error.hint = "\n".join(filter(None, [error.hint, words]))
        raise


def _read_table(request: Request, free: tuple[str, ...]) -> Reading:
    from ikgen.chains.related_rows import related_dh
    from ikgen.chains.several_sources import parted_dh, parts
    from ikgen.importers.dh.dh_table import read_dh_table

    if given := request.field_without_use:
        what = f"{given}: a DH table is one chain without arguments"
        raise UsageError(f"{request.robot}: {what}", hint=f"leave {given} out")
    source, dh = read_dh_table(request.robot, free=free, locked=request.lock)
    pinned = with_pinned(request, dh.joints)
    if pinned is not request:
        return _read_table(pinned, free)
    joints = read_dh_table(request.robot)[1].joints if request.lock else dh.joints
    followed = {joint: one.joint for joint, one in request.relations.items()}
    dh = parted_dh(dh, request.sums, followed)
    dh = related_dh(dh, request.relations | parts(request.sums))
    _check_units(request, joints)
    _check_locks(request, joints)
    return Reading(source, None, None, dh)


def _check_units(request: Request, joints: Iterable[Joint | ActuatedJoint]) -> None:
    """Raises `ArgumentError` for a value with a length's unit of a joint that turns, or an angle's of one
    that slides."""
    for joint in joints:
        revolute = _turns(joint)
        for option, values in (("--lock", request.lock), ("--free", request.free)):
            value = values.get(joint.name)
            if isinstance(value, JointValue) and not value.fits(revolute):
                kind, units = kind_and_units(revolute)
                raise ArgumentError(
                    f"{option} {joint.name}={value_text(value)}: '{value.unit}' is no unit of a joint that "
                    f"{kind}",
                    hint=f"give a value in {units}",
                )


def _turns(joint: Joint | ActuatedJoint) -> bool:
    kind = joint.type.value if isinstance(joint, Joint) else joint.kind
    return kind != PRISMATIC


def _check_locks(request: Request, joints: Iterable[Joint | ActuatedJoint]) -> None:
    """Raises `ArgumentError` for a joint that is locked outside its limits."""
    from ikgen.kinematics.free_joints import VALUE_INSIDE

    for joint in joints:
        value, limits = request.lock.get(joint.name), joint.limits
        if value is not None and not limits.lower <= value <= limits.upper:
            raise ArgumentError(
                f"--lock {joint.name}={value_text(value)}: outside the joint's limits, "
                f"{range_text(limits.lower, limits.upper, _turns(joint))}",
                hint=VALUE_INSIDE,
            )


def default_name(reading: Reading) -> str:
    """The prefix of an arm's files where none is asked for: the robot's name, with the tip's where the
    robot has several chains, so that their outputs do not meet."""
    if reading.tree is None:
        return identifier(reading.dh.robot)
    from ikgen.chains.arms import candidate_chains

    several = len(candidate_chains(reading.tree)) > 1
    return arm_name(reading.dh.robot, reading.dh.tip_link if several else "")


def arm_name(robot: str, tip: str = "") -> str:
    """An arm's name: its robot's, with that of a tip unless it begins with it."""
    name = identifier(robot)
    if not tip:
        return name
    own = identifier(tip)
    return own if own.startswith(f"{name}_") else f"{name}_{own}"
