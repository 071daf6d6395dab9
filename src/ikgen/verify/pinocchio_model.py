"""A Pinocchio model driven by the actuated joints of a chain: what emitted code is measured
against.

Pinocchio is imported here only, and only when a model is asked for.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ikgen.errors import MissingToolError
from ikgen.model.arrays import Array
from ikgen.verify.screws import ScrewChain

__all__ = ["Oracle", "load_pinocchio"]

_WHOLE = 1e-12
_MOST_ROUND, _BEYOND = 60, 2e-2
"""Of a circle of several turns: how many times what turns on it does so at most, and by how much (rad) the
limits may span less of it."""


def load_pinocchio() -> Any:
    """The module `pinocchio`; raises `MissingToolError` where it is not installed."""
    try:
        import pinocchio
    except ImportError as error:
        raise MissingToolError("verification needs Pinocchio", hint="pip install pin") from error
    return pinocchio


class Oracle:
    """A Pinocchio model of a chain, driven by the actuated joints `joint_names`.

    `wiring` maps each movable joint of `model` to (index into q, multiplier, offset).
    `lower`, `upper` (dof,): ranges that the description states, NaN where it leaves them open.
    """

    def __init__(
        self,
        model: Any,
        frames: tuple[int, int],
        links: tuple[str, str],
        joint_names: Sequence[str],
        wiring: Mapping[str, tuple[int, float, float]],
        ranges: tuple[Array, Array],
        notes: tuple[str, ...] = (),
    ) -> None:
        self._pin = load_pinocchio()
        self._model, self._data = model, model.createData()
        self._base, self._tip = (model.frames[f] for f in frames)
        self._frame_ids = frames
        self.base_link, self.tip_link = links
        self.joint_names = tuple(joint_names)
        self.lower, self.upper = ranges
        self.notes = notes
        self._wire(wiring)

    @property
    def dof(self) -> int:
        """Number of actuated joints."""
        return len(self.joint_names)

    @property
    def revolute(self) -> NDArray[np.bool_]:
        """(dof,): whether the joint's value is an angle in rad; a joint that moves nothing
        counts."""
        sliding = [~np.any(s[3:]) for s in self.screws.screws]
        return np.asarray(~np.any(self.screws.A[sliding] != 0, axis=0))

    def periods(self, span: Array) -> Array:
        """(dof,): the least step (rad) between values of a joint that are the same configuration: a whole
        turn, more or less where mimic joints turn with it; infinite where there is none, or where it is
        more than a turn, what turns does not do so alike, and `span` (dof,), between limits, is less."""
        A = np.abs(self.screws.A)
        least = np.min(np.where(A > 0.0, A, np.inf), axis=0, initial=np.inf)
        least = np.where(np.isinf(least), 1.0, least)  # a joint that moves nothing
        alike = np.all((A == 0.0) | (np.abs(A / least - 1.0) <= _WHOLE), axis=0)
        period = np.where(self.revolute & alike, 2.0 * np.pi / least, np.inf)
        for turns in range(_MOST_ROUND, 0, -1):
            rows, after = turns * A / least, 2.0 * np.pi * turns / least
            whole = np.all(np.abs(rows - np.round(rows)) <= _WHOLE, axis=0)
            around = span + _BEYOND >= after
            short = (turns <= least + _WHOLE) | (around & np.all(rows <= _MOST_ROUND, axis=0))
            period = np.where(self.revolute & whole & short, after, period)
        return np.asarray(period)

    def _wire(self, wiring: Mapping[str, tuple[int, float, float]]) -> None:
        joints = list(self._model.names)[1:]
        self._A, self._b = np.zeros((len(joints), self.dof)), np.zeros(len(joints))
        for i, name in enumerate(joints):
            driver, multiplier, offset = wiring[name]
            self._A[i, driver], self._b[i] = multiplier, offset
        self._joints = [self._model.joints[i + 1] for i in range(len(joints))]

    def _configurations(self, q: Array) -> Array:
        """Pinocchio's configuration vectors (N, nq) for q (N, dof): an unbounded joint has two
        entries."""
        values = q @ self._A.T + self._b
        full = np.empty((len(q), self._model.nq))
        for i, joint in enumerate(self._joints):
            if joint.nq == 2:
                full[:, joint.idx_q] = np.cos(values[:, i])
                full[:, joint.idx_q + 1] = np.sin(values[:, i])
            else:
                full[:, joint.idx_q] = values[:, i]
        return full

    def forward(self, q: Array) -> Array:
        """Poses (N, 4, 4) of the tip link in the base link for q (N, dof); (4, 4) for q (dof,)."""
        batch = np.atleast_2d(np.asarray(q, dtype=float))
        out = np.empty((len(batch), 4, 4))
        base, tip = self._base, self._tip
        placements, move = self._data.oMi, self._pin.forwardKinematics
        T_base_frame_world = np.linalg.inv(base.placement.homogeneous)
        for i, full in enumerate(self._configurations(batch)):
            move(self._model, self._data, full)
            out[i] = placements[tip.parentJoint].homogeneous
            if base.parentJoint:
                out[i] = placements[base.parentJoint].inverse().homogeneous @ out[i]
        out = T_base_frame_world @ out @ tip.placement.homogeneous
        return np.asarray(out[0] if np.ndim(q) == 1 else out)

    def _columns(self, full: Array) -> tuple[Array, Array]:
        """T_base_tip (4, 4) and the Jacobian (6, joints of the model) in the base link."""
        pin, model, data = self._pin, self._model, self._data
        aligned = pin.LOCAL_WORLD_ALIGNED
        J_base, J_tip = (
            np.array(pin.computeFrameJacobian(model, data, full, f, aligned)).reshape(6, model.nv)
            for f in self._frame_ids
        )
        pin.updateFramePlacements(model, data)
        T_base, T_tip = (data.oMf[f] for f in self._frame_ids)
        lever = np.asarray(T_tip.translation - T_base.translation)
        linear = J_tip[:3] - J_base[:3] - np.cross(J_base[3:].T, lever).T
        R = np.asarray(T_base.rotation).T
        J = np.vstack([R @ linear, R @ (J_tip[3:] - J_base[3:])])
        return np.asarray((T_base.inverse() * T_tip).homogeneous), J

    def jacobian(self, q: Array) -> Array:
        """Geometric Jacobians (N, 6, dof) of the tip in the base link: m/s rows, then rad/s
        rows."""
        batch = np.atleast_2d(np.asarray(q, dtype=float))
        columns = [self._columns(full)[1] @ self._A for full in self._configurations(batch)]
        out = np.array(columns).reshape(len(batch), 6, self.dof)
        return np.asarray(out[0] if np.ndim(q) == 1 else out)

    @functools.cached_property
    def screws(self) -> ScrewChain:
        """The model's kinematics as a product of exponentials, for searches over large batches."""
        home, J = self._columns(self._zero())
        J[:3] -= np.cross(J[3:].T, home[:3, 3]).T
        n = self._model.njoints - 1
        up = [i for i in self._support(self._base) if i not in self._support(self._tip)]
        down = [i for i in self._support(self._tip) if i not in self._support(self._base)]
        order = [i - 1 for i in [*reversed(up), *down]]
        assert sorted(order) == list(range(n)), "a joint of the reduced model is off the path"
        return ScrewChain(J.T[order], home, self._A[order], self._b[order])

    def _support(self, frame: Any) -> list[int]:
        return [int(i) for i in self._model.supports[frame.parentJoint] if i]

    def _zero(self) -> Array:
        return np.asarray(self._pin.neutral(self._model))
