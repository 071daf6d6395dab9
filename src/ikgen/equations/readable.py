"""Which entries of the pose in DH frames follow from those that a task reads of the given one.

Equations are in `X_base^-1 T`: an entry of it is known where all entries of T that it is made of are
read. A heading or an elevation about the base's z axis is one about the first joint's only where the
two are parallel.
"""

from __future__ import annotations

import numpy as np

from ikgen.model.dh import DHChain
from ikgen.model.entry_names import ENTRY_NAMES, entry_name, entry_place

__all__ = ["readable_in_dh"]

_ABSENT = 1e-9
"""Size up to which an entry of the base's rotation is rounding."""


def readable_in_dh(dh: DHChain, readable: frozenset[str]) -> frozenset[str]:
    """The names of the entries that are known, out of the names of those that are read."""
    return frozenset(name for name in ENTRY_NAMES if _parts(dh, name) <= readable)


def _parts(dh: DHChain, name: str) -> frozenset[str]:
    """The entries of the given pose that an entry is made of."""
    row, column = entry_place(name)
    used = np.flatnonzero(np.abs(dh.X_base[:3, row]) > _ABSENT)
    return frozenset(entry_name(k, column) for k in used.tolist())
