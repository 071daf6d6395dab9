"""Rust as a table from operation to text, and its literals."""

from __future__ import annotations

import json
import math

from ikgen.emit.printer import Language

__all__ = ["RUST_LANGUAGE", "number", "text_literal"]


def number(value: float) -> str:
    """A Rust literal that reads back to the same double."""
    if math.isinf(value):
        return "f64::INFINITY" if value > 0 else "f64::NEG_INFINITY"
    return repr(float(value))


def text_literal(text: str) -> str:
    """A Rust string literal."""
    return json.dumps(text, ensure_ascii=False)


RUST_LANGUAGE = Language(
    infix={
        "or": ("||", 1),
        "and": ("&&", 2),
        "gt": (">", 3),
        "add": ("+", 5),
        "sub": ("-", 5),
        "mul": ("*", 6),
        "div": ("/", 6),
    },
    prefix={"neg": ("-", 7), "not": ("!", 7)},
    calls={
        "sqrt": lambda x: f"f64::max({x}, 0.0).sqrt()",
        "cos": lambda x: f"f64::cos({x})",
        "sin": lambda x: f"f64::sin({x})",
        "atan2": lambda y, x: f"f64::atan2({y}, {x})",
        "abs": lambda x: f"f64::abs({x})",
        "max": lambda a, b: f"f64::max({a}, {b})",
        "min": lambda a, b: f"f64::min({a}, {b})",
        "select": lambda c, a, b: f"(if {c} {{ {a} }} else {{ {b} }})",
    },
    number=number,
)
