"""Chains made by hand and at random, and the rewritings that leave their axes alone."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from ikgen.kinematics.fixed_order import product
from ikgen.kinematics.rigid import axis_motion
from ikgen.model.arrays import Array
from ikgen.model.chain import PRISMATIC, REVOLUTE, ActuatedJoint, Chain, ChainAxis
from ikgen.model.joint_tree import Limits

FREE = Limits(-math.inf, math.inf)


def rotation(axis: list[float], angle: float) -> Array:
    """(4, 4) rotation about `axis` (3,) by `angle` (rad)."""
    n = np.asarray(axis, dtype=float) / np.linalg.norm(axis)
    K = np.array([[0.0, -n[2], n[1]], [n[2], 0.0, -n[0]], [-n[1], n[0], 0.0]])
    T = np.eye(4)
    T[:3, :3] += math.sin(angle) * K + (1 - math.cos(angle)) * (K @ K)
    return T


def translation(x: float, y: float, z: float) -> Array:
    """(4, 4) translation in m."""
    T = np.eye(4)
    T[:3, 3] = x, y, z
    return T


def chain_forward(chain: Chain, q: ArrayLike) -> Array:
    """`T_base_tip` of the file's chain as `Chain` defines it."""
    values = np.asarray(q, dtype=np.float64)
    T = np.eye(4)
    for axis in chain.axes:
        value = axis.multiplier * values[..., axis.driver] + axis.offset
        T = product(T, axis.T_prev_axis, axis_motion(axis.kind == REVOLUTE, axis.axis, value))
    return np.asarray(product(T, chain.T_last_tip))


def make_chain(
    kinds: str, transforms: list[Array], axes: list[list[float]], tip: Array | None = None
) -> Chain:
    """A chain of R and P joints from joint frames and axes in them."""
    names = {"R": REVOLUTE, "P": PRISMATIC}
    joints = tuple(ActuatedJoint(f"q{i}", names[k], FREE) for i, k in enumerate(kinds))
    chain_axes = tuple(
        ChainAxis(joint.name, joint.kind, T, np.asarray(axis, dtype=float), i)
        for i, (joint, T, axis) in enumerate(zip(joints, transforms, axes, strict=True))
    )
    tip = np.eye(4) if tip is None else tip
    return Chain("made", "base", "tip", joints, chain_axes, tip)


def rewritten(chain: Chain, rng: np.random.Generator) -> tuple[Chain, Array]:
    """The same motion with other joint frames and some axes reversed; signs (n,) of its joints.

    Each joint frame moves along and turns about its own axis (for sliding joints anywhere), and is
    then turned at random as a whole with its axis.
    """
    signs = rng.choice([-1.0, 1.0], chain.dof)
    before = np.eye(4)
    axes = []
    for axis, sign in zip(chain.axes, signs, strict=True):
        shift = rng.uniform(-1, 1, 3) if axis.kind == PRISMATIC else axis.axis * rng.uniform(-1, 1)
        change = translation(*shift) @ rotation(list(axis.axis), rng.uniform(-3, 3))
        change = change @ rotation(list(rng.normal(size=3)), rng.uniform(-3, 3))
        direction = sign * change[:3, :3].T @ axis.axis
        T = before @ axis.T_prev_axis @ change
        axes.append(ChainAxis(axis.name, axis.kind, T, direction, axis.driver))
        before = np.linalg.inv(change)
    tip = before @ chain.T_last_tip
    return Chain("rewritten", "base", "tip", chain.joints, tuple(axes), tip), signs


def random_chain(rng: np.random.Generator, kinds: str, relations: str) -> Chain:
    """Axes related to the one before: (g)eneral, (p)arallel, (a)ntiparallel, (s)ame line,
    (m)eeting, (o)rthogonal and skew."""
    turns = {"p": 0.0, "s": 0.0, "a": math.pi, "o": math.pi / 2, "m": math.pi / 2}
    transforms, axes = [], []
    frame = np.eye(4)
    for kind in relations:
        alpha = turns.get(kind, float(rng.uniform(0.3, 1.2)))
        a = 0.0 if kind in "sm" else float(rng.uniform(0.1, 0.6))
        step = rotation([0, 0, 1], rng.uniform(-3, 3)) @ translation(a, 0, 0)
        step = step @ rotation([1, 0, 0], alpha) @ translation(0, 0, rng.uniform(-0.5, 0.5))
        change = rotation(list(rng.normal(size=3)), rng.uniform(-3, 3))
        transforms.append(frame @ step @ change)
        axes.append(list(change[:3, :3].T @ [0.0, 0.0, 1.0]))
        frame = np.linalg.inv(change)
    tip = frame @ translation(*rng.uniform(-0.3, 0.3, 3)) @ rotation([1, 2, 3], 0.7)
    return make_chain(kinds, transforms, axes, tip)


__all__ = ["make_chain", "random_chain", "rewritten", "rotation", "translation"]
