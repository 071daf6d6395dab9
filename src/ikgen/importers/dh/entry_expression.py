"""Entries of a DH table: numbers, or expressions in pi and named parameters."""

from __future__ import annotations

import ast
import hashlib
import math
from collections.abc import Mapping
from dataclasses import dataclass

__all__ = ["BadEntryError", "Quantity", "evaluate", "finite", "number", "quantity_of"]

Terms = tuple[tuple[str, float], ...]

_LONGEST = 1000
_LARGEST = 1e4
"""Lengths in mm come to thousands; beyond this doubles leave no room for 1e-9 m."""


class BadEntryError(ValueError):
    """An entry that is no expression of the table's language, and a way out."""

    def __init__(self, message: str, hint: str) -> None:
        super().__init__(message)
        self.hint = hint


@dataclass(frozen=True, slots=True)
class Quantity:
    """A length (m) or angle (rad): `constant + sum(factor * name)`, with its value attached.

    What is not linear in the parameters is one term whose name is the expression's own text.
    `symbolic` if a parameter without a number is in it; its value is a generic one then.
    """

    value: float
    constant: float
    terms: Terms = ()
    symbolic: bool = False

    def __add__(self, other: Quantity) -> Quantity:
        total = dict(self.terms)
        for name, factor in other.terms:
            total[name] = total.get(name, 0.0) + factor
        return Quantity(
            self.value + other.value,
            self.constant + other.constant,
            tuple((n, f) for n, f in sorted(total.items()) if f),
            self.symbolic or other.symbolic,
        )

    def scaled(self, factor: float) -> Quantity:
        """The quantity times a number."""
        terms = tuple((n, f * factor) for n, f in self.terms if f * factor)
        return Quantity(
            self.value * factor, self.constant * factor, terms, self.symbolic and bool(terms)
        )

    def __neg__(self) -> Quantity:
        return self.scaled(-1.0)

    @property
    def single(self) -> tuple[str, float] | None:
        """The name and the sign where the quantity is one named parameter or its negative."""
        if len(self.terms) == 1 and not self.constant and abs(self.terms[0][1]) == 1.0:
            name, sign = self.terms[0]
            return (name, sign) if name.isidentifier() else None
        return None

    def is_near(self, value: float, tolerance: float = 1e-9) -> bool:
        """Whether it is the number `value`, whatever the symbols without one."""
        return not self.symbolic and abs(self.value - value) <= tolerance


def number(value: float) -> Quantity:
    """A plain number."""
    return Quantity(float(value) + 0.0, float(value) + 0.0)


def finite(value: float) -> float:
    """A number of a table as a float; raises `BadEntryError` where it is too large for the table."""
    try:
        found = float(value)
    except OverflowError:
        found = math.inf
    if math.isnan(found):
        raise BadEntryError("nan is no number", "write lengths in m, angles in rad")
    if not abs(found) <= _LARGEST:
        raise BadEntryError(
            f"{found:g} is beyond {_LARGEST:g}", "write lengths in m, angles in rad"
        )
    return found


def quantity_of(name: str, value: float | None, *, angle: bool) -> Quantity:
    """A parameter; without a value it takes a generic one that depends on its name alone."""
    if value is not None:
        return Quantity(value, 0.0, ((name, 1.0),))
    digest = int.from_bytes(hashlib.sha256(name.encode()).digest()[:6], "big") / 2.0**48
    low, high = (0.35, 0.95) if angle else (0.4, 1.6)
    return Quantity(low + (high - low) * digest, 0.0, ((name, 1.0),), True)


def evaluate(text: str, names: Mapping[str, float | None], *, angle: bool) -> Quantity:
    """The quantity that an expression says: + - * /, sqrt, parentheses, pi and parameter names.

    `names` gives parameters their values; a name that is not in it stays a symbol. Raises
    `BadEntryError`.
    """
    hint = "write a number or an expression with + - * / sqrt() pi and parameter names"
    if len(text) > _LONGEST:
        raise BadEntryError(f"an expression of {len(text)} characters", hint)
    try:
        tree = ast.parse(text.strip(), mode="eval")
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        raise BadEntryError(f"'{text}' is not an expression", hint) from None
    try:
        result = _visit(tree.body, names, angle)
    except ZeroDivisionError:
        raise BadEntryError(f"'{text}' divides by zero", "check its parameters") from None
    except (OverflowError, RecursionError):
        raise BadEntryError(f"'{text}' is too large", hint) from None
    except BadEntryError as error:
        raise BadEntryError(f"'{text}': {error}", error.hint or hint) from None
    if not math.isfinite(result.value):
        raise BadEntryError(f"'{text}' is not finite", "check its parameters")
    return result


def _visit(node: ast.expr, names: Mapping[str, float | None], angle: bool) -> Quantity:
    match node:
        case ast.Constant(value=bool()):
            raise BadEntryError("true and false are no numbers", "")
        case ast.Constant(value=int() | float() as value):
            return number(value)
        case ast.Name(id="pi"):
            return number(math.pi)
        case ast.Name(id=name):
            return quantity_of(name, names.get(name), angle=angle)
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return -_visit(operand, names, angle)
        case ast.UnaryOp(op=ast.UAdd(), operand=operand):
            return _visit(operand, names, angle)
        case ast.BinOp(left=left, op=op, right=right):
            return _binary(node, op, _visit(left, names, angle), _visit(right, names, angle))
        case ast.Call(func=ast.Name(id="sqrt"), args=[argument], keywords=[]):
            inner = _visit(argument, names, angle)
            if inner.value < 0.0:
                raise BadEntryError(f"square root of {inner.value:g}", "check its parameters")
            return _opaque(node, math.sqrt(inner.value), inner)
        case ast.Call(func=ast.Name(id=name)):
            raise BadEntryError(f"'{name}' is no function of the table", "")
    raise BadEntryError(f"'{ast.unparse(node)}' is not allowed", "")


def _binary(node: ast.expr, op: ast.operator, left: Quantity, right: Quantity) -> Quantity:
    match op:
        case ast.Add():
            return left + right
        case ast.Sub():
            return left + -right
        case ast.Mult() if not left.terms:
            return right.scaled(left.value)
        case ast.Mult() if not right.terms:
            return left.scaled(right.value)
        case ast.Mult():
            return _opaque(node, left.value * right.value, left, right)
        case ast.Div() if not right.terms:
            return left.scaled(1.0 / right.value)
        case ast.Div():
            return _opaque(node, left.value / right.value, left, right)
        case ast.Pow() if not (left.terms or right.terms) and left.value > 0.0:
            return number(left.value**right.value)
        case ast.Pow() if right.is_near(2.0) and not right.terms:
            return _opaque(node, left.value**2, left)
    raise BadEntryError(f"'{ast.unparse(node)}' is not allowed", "")


def _opaque(node: ast.expr, value: float, *parts: Quantity) -> Quantity:
    """What is not linear: a number, or one term named by its text."""
    if not any(part.terms for part in parts):
        return number(value)
    text = f"({ast.unparse(node)})"
    return Quantity(value, 0.0, ((text, 1.0),), any(part.symbolic for part in parts))
