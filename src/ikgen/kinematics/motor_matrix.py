"""The matrix between motors and joints, from relations that name several of them."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ikgen.errors import UnknownNameError, UsageError
from ikgen.kinematics.rigid import read_only
from ikgen.model.arrays import Array
from ikgen.model.dh import DHChain
from ikgen.model.joint_relation import Relation
from ikgen.model.transmission import Transmission

__all__ = ["motor_matrix"]

_LEAST = 1e-9
"""Smallest singular value of the matrix, rows and columns scaled to 1, that leaves digits of the motors."""


def motor_matrix(dh: DHChain, relations: Mapping[str, Relation]) -> Transmission:
    """The transmission of a chain whose joints have these relations to motors; each other joint has a motor
    of its own.

    Raises `UnknownNameError` for a joint that is none of the chain's independent ones, `UsageError` where
    several values of the motors are the same configuration.
    """
    names = [joint.name for joint in dh.joints]
    matrix, offset = np.eye(len(names)), np.zeros(len(names))
    for joint, relation in relations.items():
        for name in (joint, *(source for source, _ in relation.terms)):
            _check(dh, names, name)
        row = names.index(joint)
        matrix[row] = 0.0
        offset[row] = relation.offset
        for source, multiplier in relation.terms:
            matrix[row, names.index(source)] = multiplier
    _check_motors(names, matrix, offset, relations)
    inverse = np.linalg.inv(matrix) + 0.0
    return Transmission(read_only(matrix), read_only(inverse), read_only(offset))


def _check(dh: DHChain, names: list[str], name: str) -> None:
    if name in dict(dh.locked):
        raise UsageError(
            f"--couple: joint '{name}' is locked, so its motor cannot move others",
            hint=f"leave out --lock {name}, or the relations that name it",
        )
    if name in {row.name for row in dh.rows} - {*names}:
        raise UsageError(
            f"--couple: joint '{name}' follows another, and has no motor",
            hint="name the joint that it follows, or give a relation of its motor in place of that",
        )
    if name not in names:
        raise UnknownNameError("joint", name, names)


def _check_motors(
    names: list[str], matrix: Array, offset: Array, relations: Mapping[str, Relation]
) -> None:
    if not offset.any() and np.array_equal(matrix, np.eye(len(names))):
        raise UsageError(
            f"--couple: '{next(iter(relations))}' follows itself",
            hint="name another joint that it follows",
        )
    scaled = matrix / np.abs(matrix).max(axis=0)
    scaled /= np.abs(scaled).max(axis=1, keepdims=True)
    if np.linalg.svd(scaled, compute_uv=False)[-1] < _LEAST:
        raise UsageError(
            f"--couple: the relations of {', '.join(relations)} do not tell their motors apart",
            hint="give relations that can be solved for the motors' values",
        )
