"""The emitted routine itself, for probing: the same text that goes into generated modules."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any, cast

import numpy as np

from ikgen.errors import IkgenError
from ikgen.model.joint_tree import Matrix

__all__ = ["Elimination", "general_6r", "general_6r_batch", "initial_residuals"]

Elimination = tuple[int, int, int]
_HEAD = (
    "from __future__ import annotations\n"
    "import math\nfrom functools import cmp_to_key\nimport numpy as np\nfrom numpy.typing import NDArray\n"
)
_NAME = "general_6r.py.jinja"


@cache
def _namespace() -> dict[str, Any]:
    package = Path(__file__).resolve().parent.parent
    for root in (package, package.parent.parent):
        path = root / "templates" / "python" / "routines" / _NAME
        if path.is_file():
            namespace: dict[str, Any] = {"__name__": "general_6r"}
            exec(compile(_HEAD + path.read_text(encoding="utf-8"), str(path), "exec"), namespace)
            return namespace
    raise IkgenError(f"no template '{_NAME}' in this installation", hint="reinstall ikgen")


def general_6r_batch(
    frames: Matrix, length: float, plans: Sequence[Elimination], poses: Matrix
) -> list[Matrix]:
    """All joint angles (k, 6) in (-pi, pi] that reach each of the poses (N, 4, 4).

    frames (7, 4, 4): the chain as in `frames.py`; length (m): its scale; plans in order of
    preference.
    """
    found = _namespace()["general_6r_batch"](frames, length, tuple(plans), poses)
    return cast("list[Matrix]", found)


def general_6r(frames: Matrix, length: float, plans: Sequence[Elimination], pose: Matrix) -> Matrix:
    """`general_6r_batch` for one pose (4, 4)."""
    return general_6r_batch(frames, length, plans, np.asarray(pose, dtype=np.float64)[None])[0]


def initial_residuals(
    frames: Matrix, length: float, plan: Elimination, poses: Matrix
) -> tuple[list[Matrix], Matrix]:
    """One plan's solutions for poses (N, 4, 4), and the pose errors (m,) of those candidates that
    became solutions, before Newton's method: how well conditioned the elimination is."""
    space = _namespace()
    F, T = frames.copy(), poses.copy()
    F[:, :3, 3] /= length
    T[:, :3, 3] /= length
    index, q, *_ = space["_g6_candidates"](F, T, plan)
    if not len(q):
        return [np.zeros((0, 6)) for _ in poses], np.zeros(0)
    q, after, before = space["_g6_polish"](F, T[index], q)
    good = after < 1e-9
    rows = [space["_g6_distinct"](q[good & (index == i)]) for i in range(len(poses))]
    return rows, np.asarray(before[good], dtype=np.float64)
