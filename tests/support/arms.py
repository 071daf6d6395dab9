"""Chains straight out of `arms.json`, the collection of real arms that benchmarks use too."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ikgen.model.arrays import Array
from ikgen.model.chain import ActuatedJoint, Chain, ChainAxis
from ikgen.model.joint_tree import Limits


def origin(xyz: list[float], rpy: list[float]) -> Array:
    """URDF origin as (4, 4): `Rz(yaw) Ry(pitch) Rx(roll)`."""
    (cr, cp, cy), (sr, sp, sy) = (tuple(f(v) for v in rpy) for f in (math.cos, math.sin))
    T = np.eye(4)
    T[:3, :3] = [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]
    T[:3, 3] = xyz
    return T


def arm_chain(arm: dict[str, Any]) -> Chain:
    """The arm's chain, fixed joints merged, mimic joints driven by their sources."""
    joints: list[ActuatedJoint] = []
    axes: list[ChainAxis] = []
    index: dict[str, int] = {}
    T = np.eye(4)
    for entry in arm["chain"]:
        T = T @ origin(entry["xyz"], entry["rpy"])
        if entry["type"] == "fixed":
            continue
        kind = entry.get("base_type", entry["type"])
        axis = np.array(entry.get("axis", [1.0, 0.0, 0.0]), dtype=float)
        axis /= np.linalg.norm(axis)
        moving = "prismatic" if kind == "prismatic" else "revolute"
        mimic = entry.get("mimic") if entry["type"] == "mimic" else None
        if mimic is None:
            index[entry["joint"]] = len(joints)
            limits = Limits(entry["lower"] or -math.inf, entry["upper"] or math.inf)
            joints.append(ActuatedJoint(entry["joint"], moving, limits, kind == "continuous"))
            axes.append(ChainAxis(entry["joint"], moving, T, axis, len(joints) - 1))
        else:
            driver = index[mimic["joint"]]
            factors = float(mimic["multiplier"]), float(mimic["offset"])
            axes.append(ChainAxis(entry["joint"], moving, T, axis, driver, *factors))
        T = np.eye(4)
    return Chain(arm["name"], arm["base_link"], arm["tip_link"], tuple(joints), tuple(axes), T)
