"""How far an output's forward kinematics are from a description's."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ikgen.model.dh import DHChain
    from ikgen.verify.oracle import Oracle

__all__ = ["ForwardDifference", "forward_difference"]

_SAME = 1e-9
_SAMPLES = 200


@dataclass(frozen=True, slots=True)
class ForwardDifference:
    """The difference in words, and as the largest (m, rad); None where there are no poses to compare."""

    words: str
    deviation: tuple[float, float] | None = None


def forward_difference(runner: Any, oracle: Oracle, dh: DHChain) -> ForwardDifference | None:
    """The largest difference over random configurations; None if they agree."""
    import numpy as np

    from ikgen.kinematics.forward import pose_difference
    from ikgen.kinematics.joint_box import joint_box

    q = np.random.default_rng(0).uniform(*joint_box(dh, np.pi), size=(_SAMPLES, dh.dof))
    try:
        ours = runner.forward(q)
    except Exception as error:
        return ForwardDifference(f"forward raises {type(error).__name__}: {error}")
    theirs = oracle.forward(q)
    if ours.shape != theirs.shape or not np.isfinite(ours).all():
        return ForwardDifference("forward gives no poses")
    return _worded(*pose_difference(ours, theirs))


def _worded(metres: float, radians: float) -> ForwardDifference | None:
    if max(metres, radians) <= _SAME:
        return None
    metres, radians = (value if value > _SAME else 0.0 for value in (metres, radians))
    words = (
        "made from another geometry: its forward kinematics differ from the description's by up to "
        f"{1e3 * metres:.6g} mm and {radians:.6g} rad"
    )
    return ForwardDifference(words, (metres, radians))
