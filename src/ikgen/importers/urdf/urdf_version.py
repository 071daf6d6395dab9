"""What the version of a URDF changes in how it is read."""

from __future__ import annotations

import re

__all__ = ["has_quaternions"]

_VERSION = re.compile(r"\s*(\d+)\.(\d+)\s*")


def has_quaternions(version: str | None) -> bool:
    """Whether origins of a `<robot>` of that `version` may have `quat_xyzw` in place of `rpy`: from 1.1 on
    (urdfdom 6). A file that states none is of 1.0."""
    found = _VERSION.fullmatch(version or "")
    return found is not None and (int(found[1]), int(found[2])) >= (1, 1)
