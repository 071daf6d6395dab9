"""Checks on the functions around `solve`: constants, kinematics, batch, repeatability, bad
input."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ikgen.model.arrays import Array
from ikgen.verify.arm import ArmUnderTest
from ikgen.verify.completeness import sensitivity
from ikgen.verify.reach import invalid_poses
from ikgen.verify.runners.runner import Rows, Runner
from ikgen.verify.sampling import SampleSet
from ikgen.verify.trials import Trial, nearest, result, spell
from ikgen.verify.verification_report import CheckResult

__all__ = [
    "check_batch", "check_constants", "check_determinism", "check_forward", "check_invalid",
    "check_jacobian", "check_shapes",
]  # fmt: skip


SAME_TOLERANCE = 1e-9  # m, rad: two functions that compute the same
SETTLED = (
    1e-12  # rad, lengths of the arm: what Newton steps that end leave of a row's error, and more
)


def _other_bounds(arm: ArmUnderTest, ours: Array, files: Array) -> str:
    """The joints whose bound differs by more than 1e-9 from what the file states (NaN: it states none), in
    words; "" where none does."""
    other = ~(np.isnan(files) | np.isclose(ours, files, rtol=1e-9, atol=1e-9))
    names = arm.oracle.joint_names
    words = (f"{names[j]} has {ours[j]:.9g}, not {files[j]:.9g}" for j in np.flatnonzero(other))
    return f": {', '.join(words)}" if other.any() else ""


def _allowed(arm: ArmUnderTest, defaults: tuple[float, ...] | None) -> bool:
    """Whether the defaults of the free joints, where they are known, lie inside the limits."""
    if defaults is None:
        return True
    values, held = np.array(defaults, dtype=float), list(arm.free)
    if values.shape != (len(arm.held),):
        return False
    turn = [np.pi] * (len(arm.held) - len(held))
    low, high = np.append(arm.lower[held], np.negative(turn)), np.append(arm.upper[held], turn)
    inside = (low <= values) & (values <= high)
    return bool(np.all(inside & np.isfinite(values)))


def check_constants(arm: ArmUnderTest, runner: Runner, rows: Rows) -> CheckResult:
    """The module's constants are the description's, and MAX_SOLUTIONS holds for the `rows` seen."""
    constants, oracle = runner.constants, arm.oracle
    right = {
        "joint names": constants.joint_names == oracle.joint_names,
        "links": (constants.base_link, constants.tip_link) == (oracle.base_link, oracle.tip_link),
        "task": constants.task == arm.task.name,
        "free joints": constants.free_joints == arm.held,
        "defaults of free joints": _allowed(arm, constants.free_defaults),
        "shape of limits": constants.lower.shape == constants.upper.shape == (oracle.dof,),
        "most solutions": int(np.max(rows.count, initial=0)) <= constants.max_solutions,
    }
    if right["shape of limits"]:
        for name, ours, files, arms in (
            ("lower limits", constants.lower, oracle.lower, arm.lower),
            ("upper limits", constants.upper, oracle.upper, arm.upper),
        ):
            others = _other_bounds(arm, ours, files) or _other_bounds(arm, ours, arms)
            right[f"{name}{others}"] = not others
    wrong = [name for name, fits in right.items() if not fits]
    return result("constants", len(right), len(wrong), detail=", ".join(wrong))


def _compare(
    name: str, ours: Array, true: Array, sample: SampleSet, unit: Array | float = 1.0
) -> CheckResult:
    """Entry by entry, each error in units of `unit`."""
    if ours.shape != true.shape:
        detail = f"shape {ours.shape} instead of {true.shape}"
        return result(name, len(true), len(true), detail=detail)
    error = (np.abs(ours - true) / unit).reshape(len(true), -1).max(axis=1, initial=0.0)
    error = np.where(np.isnan(error), np.inf, error)
    k = int(np.argmax(error))
    case = spell(sample.label, k, q=sample.q[k])
    worst = (("largest entry", float(error[k])),)
    return result(name, len(true), int(np.sum(error > SAME_TOLERANCE)), worst, worst_case=case)


def check_forward(runner: Runner, sample: SampleSet) -> CheckResult:
    """`forward` equals the oracle, entry by entry (m and 1)."""
    return _compare("forward", runner.forward(sample.q), sample.poses, sample)


def check_jacobian(arm: ArmUnderTest, runner: Runner, sample: SampleSet) -> CheckResult:
    """`jacobian` equals the oracle's, entry by entry (m/s and rad/s per unit joint speed); a column above
    1, as of a joint that others follow many times as fast, in units of its largest entry."""
    true = arm.oracle.jacobian(sample.q)
    unit = np.maximum(1.0, np.abs(true).max(axis=-2, keepdims=True))
    return _compare("jacobian", runner.jacobian(sample.q), true, sample, unit)


def check_batch(arm: ArmUnderTest, runner: Runner, sample: SampleSet, single: Rows) -> CheckResult:
    """`solve_batch` returns the same rows and status as `solve`, free joints at their defaults, `single`.
    Where the arm is all but singular, the two may differ by what the last steps of either leave."""
    name, batch = "solve_batch", runner.solve_batch(sample.poses)
    if batch is None:
        return result(name, 0, 0, detail=f"{runner.label} has none")
    if batch.q.ndim != 3 or batch.q.shape[::2] != single.q.shape[::2]:
        return result(name, len(single), len(single), detail=f"shape of q {batch.q.shape}")
    beyond = np.isnan(batch.q).any(axis=2) != ~batch.mask
    wrong = _others(arm, batch, single) | _others(arm, single, batch)
    wrong |= (batch.count != single.count) | beyond.any(axis=1)
    wrong |= np.array([a != b for a, b in zip(batch.status, single.status, strict=True)])
    case = ""
    if wrong.any():
        i = int(np.argmax(wrong))
        case = spell(sample.label, i, batch=batch.q[i], single=single.q[i])
    return result(name, len(single), int(wrong.sum()), worst_case=case)


def _others(arm: ArmUnderTest, rows: Rows, reference: Rows) -> NDArray[np.bool_]:
    """The poses (N,) at which some row is none of the reference's."""
    off = np.where(rows.mask, nearest(arm, rows.q, reference.q), 0.0)
    pose, k = np.nonzero(off > SAME_TOLERANCE)
    moved = sensitivity(arm, rows.q[pose, k]).moved(SETTLED)
    wrong = np.zeros(len(off), dtype=bool)
    wrong[pose[off[pose, k] > SAME_TOLERANCE + moved]] = True
    return wrong


def check_determinism(first: Trial, second: Trial) -> CheckResult:
    """Equal poses, solved twice, give the same bits."""
    same = [np.array_equal(a, b) for a, b in zip(first.rows, second.rows, strict=True)]
    return result("determinism", len(same), len(same) - sum(same))


def check_invalid(arm: ArmUnderTest, runner: Runner, pose: Array) -> CheckResult:
    """NaN, infinities and what is no rotation are INVALID, without rows and without an
    exception."""
    wrong = []
    cases = invalid_poses(arm.task, pose)
    for label, bad in cases.items():
        try:
            q, status, _ = runner.solve(bad)
        except Exception as error:
            wrong.append(f"{label}: raises {type(error).__name__}")
            continue
        if len(q) or status != "INVALID":
            wrong.append(f"{label}: {status}, {len(q)} rows")
    return result("invalid poses", len(cases), len(wrong), detail="; ".join(wrong))


def check_shapes(arm: ArmUnderTest, runner: Runner, pose: Array) -> CheckResult:
    """Inputs of a wrong shape raise `ValueError`, where the language lets them through at all."""
    if not runner.dynamic_shapes:
        return result("bad shapes", 0, 0, detail=f"the types of {runner.label} exclude them")
    dof, wrong = runner.constants.dof, []
    size = 3 if arm.task.position else 2  # a rotation alone does where no position is read
    attempts: dict[str, Callable[[], object]] = {
        f"pose ({size}, {size})": lambda: runner.solve(np.eye(size)),
        "pose (16,)": lambda: runner.solve(pose.reshape(16)),
        "seed too long": lambda: runner.solve(pose, seed=np.zeros(dof + 1)),
        "forward of q too long": lambda: runner.forward(np.zeros((1, dof + 1))),
    }
    for label, attempt in attempts.items():
        try:
            attempt()
            wrong.append(f"{label}: no error")
        except ValueError:
            pass
        except Exception as error:
            wrong.append(f"{label}: {type(error).__name__}")
    return result("bad shapes", len(attempts), len(wrong), detail="; ".join(wrong))
