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

    rng = np.random.default_rng(0)
    limits = [joint.limits for joint in dh.joints]
    low = np.array([max(x.lower, -np.pi) for x in limits])
    high = np.array([min(x.upper, np.pi) for x in limits])
    q = rng.uniform(np.minimum(low, high), np.maximum(low, high), size=(_SAMPLES, len(limits)))
    try:
        ours = runner.forward(q)
    except Exception as error:
        return ForwardDifference(f"forward raises {type(error).__name__}: {error}")
    theirs = oracle.forward(q)
    if ours.shape != theirs.shape or not np.isfinite(ours).all():
        return ForwardDifference("forward gives no poses")
    metres = float(np.linalg.norm(ours[:, :3, 3] - theirs[:, :3, 3], axis=1).max())
    turn = np.linalg.norm(ours[:, :3, :3] - theirs[:, :3, :3], axis=(1, 2)).max()
    radians = float(2.0 * np.arcsin(min(1.0, turn / np.sqrt(8.0))))
    return _worded(metres, radians)


def _worded(metres: float, radians: float) -> ForwardDifference | None:
    if max(metres, radians) <= _SAME:
        return None
    metres, radians = (value if value > _SAME else 0.0 for value in (metres, radians))
    words = (
        "made from another geometry: its forward kinematics differ from the description's by up to "
        f"{1e3 * metres:.6g} mm and {radians:.6g} rad"
    )
    return ForwardDifference(words, (metres, radians))
