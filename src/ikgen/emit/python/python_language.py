"""Operations as Python text: on floats with `math`, and on arrays with NumPy."""

from __future__ import annotations

import math

from ikgen.emit.printer import Language

__all__ = ["BATCH", "SCALAR", "number"]

_INFIX = {
    "or": ("or", 1),
    "and": ("and", 2),
    "gt": (">", 4),
    "add": ("+", 5),
    "sub": ("-", 5),
    "mul": ("*", 6),
    "div": ("/", 6),
}


def number(value: float) -> str:
    """A float's literal that reads back as the same bits."""
    if math.isinf(value):
        return "inf" if value > 0 else "-inf"
    if math.isnan(value):
        return "nan"
    return repr(float(value))


SCALAR = Language(
    infix=_INFIX,
    prefix={"neg": ("-", 7), "not": ("not ", 3)},
    calls={
        "sqrt": lambda x: (
            f"sqrt({x} if {x} > 0.0 else 0.0)" if x.isidentifier() else f"sqrt(max({x}, 0.0))"
        ),
        "cos": lambda x: f"cos({x})",
        "sin": lambda x: f"sin({x})",
        "atan2": lambda y, x: f"atan2({y}, {x})",
        "abs": lambda x: f"abs({x})",
        "max": lambda a, b: f"max({a}, {b})",
        "min": lambda a, b: f"min({a}, {b})",
        "select": lambda c, a, b: f"({a} if {c} else {b})",
    },
    number=number,
)

BATCH = Language(
    infix={**_INFIX, "or": ("|", 3), "and": ("&", 3)},
    prefix={"neg": ("-", 7), "not": ("~", 7)},
    calls={
        "sqrt": lambda x: f"np.sqrt(np.maximum({x}, 0.0))",
        "cos": lambda x: f"np.cos({x})",
        "sin": lambda x: f"np.sin({x})",
        "atan2": lambda y, x: f"np.arctan2({y}, {x})",
        "abs": lambda x: f"np.abs({x})",
        "max": lambda a, b: f"np.maximum({a}, {b})",
        "min": lambda a, b: f"np.minimum({a}, {b})",
        "select": lambda c, a, b: f"np.where({c}, {a}, {b})",
        "gt": lambda a, b: f"({a} > {b})",
        "or": lambda a, b: f"({a} | {b})",
        "and": lambda a, b: f"({a} & {b})",
        "not": lambda a: f"~{a}",
    },
    number=number,
)
