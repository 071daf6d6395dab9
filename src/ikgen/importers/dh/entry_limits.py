"""The limits of a DH table's joints: optional, numbers or expressions."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from ikgen.importers.dh.entry_expression import BadEntryError, evaluate
from ikgen.importers.dh.table_document import TableDocument
from ikgen.importers.urdf.joint_limits import FARTHEST, PINNED, UNLIMITED, turning_limits
from ikgen.model.joint_tree import Limits
from ikgen.model.joint_value import kind_and_units, parse_joint_value

__all__ = ["read_limits"]

_HINT = "write limits = [lower, upper] in rad or m, or leave them out"


def read_limits(
    document: TableDocument,
    i: int,
    joint: Mapping[str, Any],
    parameters: Mapping[str, float | None],
) -> Limits:
    """The range of joint number `i` (rad or m), infinite without limits."""
    given = joint.get("limits")
    if given is None:
        return UNLIMITED
    if joint["type"] == "fixed":
        raise document.error("a fixed joint has no limits", "remove them", joint=i, key="limits")
    if not isinstance(given, list) or len(given) != 2:
        raise document.error("limits are not two numbers", _HINT, joint=i, key="limits")
    values = []
    for one in given:
        if isinstance(one, bool) or not isinstance(one, int | float | str):
            raise document.error(f"limit {one!r} is no number", _HINT, joint=i, key="limits")
        try:
            value = _of_text(one, joint, parameters) if isinstance(one, str) else _as_float(one)
        except BadEntryError as error:
            raise document.error(f"limits: {error}", error.hint, joint=i, key="limits") from None
        if math.isnan(value):
            raise document.error(f"limit {one!r} has no number", _HINT, joint=i, key="limits")
        values.append(value)
    if values[0] > values[1]:
        raise document.error(
            f"the lower limit {values[0]:g} is above the upper limit {values[1]:g}", _HINT,
            joint=i, key="limits",
        )  # fmt: skip
    if values[0] > FARTHEST or values[1] < -FARTHEST:
        message = f"limits {values[0]:g} to {values[1]:g} hold no value that can be told apart"
        raise document.error(message, _HINT, joint=i, key="limits")
    if values[0] == values[1]:
        document.warn(f"joint {i}: limits {values[0]:g} to {values[1]:g}: {PINNED}")
    if joint["type"] != "revolute":
        return Limits(values[0], values[1])
    limits, odd = turning_limits(values[0], values[1])
    for words in odd:
        document.warn(f"joint {i}: {words}")
    return limits


def _of_text(text: str, joint: Mapping[str, Any], parameters: Mapping[str, float | None]) -> float:
    """A limit in rad or m: an expression, of NaN where it has no number, or a number with its unit."""
    try:
        found = parse_joint_value(text)
    except ValueError:
        read = evaluate(text, parameters, angle=True)
        return math.nan if read.symbolic else read.value
    turns = joint["type"] == "revolute"
    if not found.fits(turns):
        kind, units = kind_and_units(turns)
        raise BadEntryError(f"'{text}' is no value of a joint that {kind}", f"write it in {units}")
    return float(found)


def _as_float(value: Any) -> float:
    try:
        return float(value)
    except OverflowError:
        return math.copysign(math.inf, value)
