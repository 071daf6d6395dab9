"""Joints whose limits leave one value: they cannot move, and are constants unless they are to be inputs."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ikgen.model.chain import ActuatedJoint
    from ikgen.model.joint_tree import JointTree
    from ikgen.records.request import Request

__all__ = ["pinned_in_chain", "with_pinned"]


def pinned_in_chain(request: Request, tree: JointTree) -> Request:
    """The request with what cannot move of the chain that is meant locked."""
    from ikgen.chains.selection import select_chain

    moving = (joint.limits for joint in tree.joints if joint.type.moves_on_one_axis)
    if all(limits.lower < limits.upper for limits in moving):
        return request
    chain = select_chain(tree, request.base, request.tip, dict(request.lock))
    return with_pinned(request, chain.joints)


def with_pinned(request: Request, joints: Iterable[ActuatedJoint]) -> Request:
    """The request with those of the joints locked that cannot move and that it does not name."""
    named = {*request.free, *request.lock, *request.couple}
    named |= {mimic.joint for mimic in request.relations.values()}
    several = (request.sums | request.motors).values()
    named |= {source for relation in several for source, _ in relation.terms}
    found = {
        joint.name: joint.limits.lower
        for joint in joints
        if joint.limits.lower == joint.limits.upper and joint.name not in named
    }
    return replace(request, lock={**request.lock, **found}) if found else request
