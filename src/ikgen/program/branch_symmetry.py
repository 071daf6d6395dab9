"""What both branches of a level share: values that are even or odd in its sign.

Where an unknown is told by `sigma` = +1 or -1, much that follows from it is the same in both branches, or
the same but for its sign: of a spherical wrist all but its flip, of an elbow the size of its sine. Such
values move to the level before, once for both, and leave the signs. A product with a sign is exact: numbers
stay as they are to the last bit, but for angles whose cosine changes its sign: these are taken from half a
turn.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import reduce
from operator import xor

from ikgen.program.liveness import trimmed
from ikgen.program.ops import BOOLEAN, Op, Operand, operand_names
from ikgen.program.remarks import Remarked, remarked, with_remarks
from ikgen.program.statements import Let, Level, Program, Require

__all__ = ["with_shared_branches"]

Signs = frozenset[str]
NONE: Signs = frozenset()

_BELOW_PI = math.nextafter(math.pi, 0.0)


@dataclass(frozen=True, slots=True)
class Part:
    """A value of a level: the product of signs of that level and of `plus`, which is known before it and is
    the value where all signs are +1."""

    signs: Signs
    plus: Operand


def with_shared_branches(program: Program, least: int = 2) -> Program:
    """The Program with every value that is even or odd in a level's sign computed before that level, where
    the level has `least` rows or more."""
    told: list[str | None] = []
    rows = 1
    for level in program.levels:
        rows *= level.branches
        told.append(level.sigma if rows >= least else None)
    return _Sharing(program, told).result() if any(told) else program


class _Sharing:
    """The statements, each where it belongs; `told`: the signs of the levels whose values move."""

    def __init__(self, program: Program, told: Sequence[str | None]) -> None:
        self.program, self.told = program, told
        self.home: dict[str, int] = {}
        self.parts: dict[str, Part] = {}
        self.bodies: list[list[Remarked]] = [[] for _ in program.levels]
        self.known: dict[Operand, str] = {}
        self._made = 0
        self._remark = ""
        for index, level in enumerate(program.levels):
            self._enter(index, level)
            for remark, statement in remarked(level.body):
                self._remark = remark
                self._take(index, statement)

    def result(self) -> Program:
        """The Program without what nothing reads any more."""
        levels = (
            replace(level, body=with_remarks(body), solved=self._solved(level))
            for level, body in zip(self.program.levels, self.bodies, strict=True)
        )
        return trimmed(replace(self.program, levels=tuple(levels)))

    def _solved(self, level: Level) -> tuple[str, ...]:
        """Cosine and sine that both change their sign are half a turn apart: such branches never meet."""
        signs = [self.parts[n].signs if n in self.parts else NONE for n in level.solved]
        apart = len(signs) == 2 and signs[0] == signs[1] != NONE
        return () if apart else level.solved

    # -- statements ------------------------------------------------------------------------------

    def _enter(self, index: int, level: Level) -> None:
        if level.sigma is not None:
            self.home[level.sigma] = index
        sign = self.told[index]
        if sign is not None:
            self.parts[sign] = Part(frozenset({sign}), 1.0)
        if level.call is not None:
            self.home |= dict.fromkeys(level.call.names, index)

    def _take(self, index: int, statement: Let | Require) -> None:
        """Puts a statement where it belongs, which is at its own level or before it."""
        if self.told[index] is None:
            self._put(index, statement)
            return
        if isinstance(statement, Require):
            part = self._part(statement.condition, index)
            if part is not None:
                shared = replace(statement, condition=part.plus)
                self._take(self._level(part.plus), shared)
            else:
                condition = self._rebuilt(statement.condition, index)
                self._put(index, replace(statement, condition=condition))
            return
        part = self._part(statement.value, index)
        if part is None:
            self._put(index, replace(statement, value=self._rebuilt(statement.value, index)))
        elif part.signs:
            part = Part(part.signs, self._shared(part.plus, f"{statement.name}_plus"))
            self._put(index, replace(statement, value=self._signed(part, index)))
            self.parts[statement.name] = part
        else:
            self._take(self._level(part.plus), replace(statement, value=part.plus))

    def _put(self, index: int, statement: Let | Require) -> None:
        if isinstance(statement, Let):
            self.home[statement.name] = index
            self.known.setdefault(statement.value, statement.name)
        self.bodies[index].append((self._remark, statement))

    def _shared(self, value: Operand, name: str = "") -> Operand:
        """The value by a name, computed where it is known."""
        if not isinstance(value, Op):
            return value
        if value in self.known:
            return self.known[value]
        name = name or self._new_name("y")
        self._take(self._level(value), Let(name, value, value.op in BOOLEAN))
        return name

    def _new_name(self, stem: str) -> str:
        self._made += 1
        return f"{stem}{self._made}"

    # -- operands --------------------------------------------------------------------------------

    def _level(self, operand: Operand) -> int:
        return max((self.home.get(name, 0) for name in operand_names(operand)), default=0)

    def _part(self, operand: Operand, index: int) -> Part | None:
        """The operand as a value of a level, or None where it is neither even nor odd in its signs."""
        if not isinstance(operand, Op):
            if isinstance(operand, str) and self.home.get(operand, 0) == index:
                return self.parts.get(operand)
            return Part(NONE, operand)
        found = [self._part(one, index) for one in operand.args]
        parts = [one for one in found if one is not None]
        if len(parts) < len(found):
            return None
        plus = tuple(one.plus for one in parts)
        if operand.op == "select":
            return self._choice(plus, [one.signs for one in parts], index)
        signs = _signs(operand.op, [one.signs for one in parts])
        return None if signs is None else Part(signs, _simple(operand.op, plus))

    def _choice(self, plus: tuple[Operand, ...], signs: Sequence[Signs], index: int) -> Part | None:
        """Either of two values, each with signs of its own: so is the product of these."""
        if signs[0]:
            return None
        value = Op("select", plus)
        if signs[1] == signs[2]:
            return Part(signs[1], value)
        either = (plus[0], self._product(signs[1], index), self._product(signs[2], index))
        name = self._sign(Op("select", either), index)
        self.parts[name] = Part(frozenset({name}), 1.0)
        return Part(self.parts[name].signs, value)

    def _product(self, signs: Signs, index: int) -> Operand:
        """The product of signs of a level."""
        if not signs:
            return 1.0
        product, *others = sorted(signs)
        for sign in others:
            product = self._sign(Op("mul", (product, sign)), index)
        return product

    def _sign(self, value: Op, index: int) -> str:
        """A value of a level that is +1 or -1, by a name."""
        if value not in self.known:
            self._put(index, Let(self._new_name("sign_"), value))
        return self.known[value]

    def _signed(self, part: Part, index: int) -> Operand:
        """The value of a part."""
        sign = self._product(part.signs, index)
        return sign if part.plus == 1.0 else Op("mul", (sign, part.plus))

    def _rebuilt(self, operand: Operand, index: int) -> Operand:
        """An operand that is neither even nor odd, of what in it can be shared."""
        if not isinstance(operand, Op):
            return operand
        part = self._part(operand, index)
        if part is not None:
            part = Part(part.signs, self._shared(part.plus))
            return self._signed(part, index) if part.signs else part.plus
        if operand.op == "atan2":
            found = self._angle(operand, index)
            if found is not None:
                return found
        return Op(operand.op, tuple(self._rebuilt(a, index) for a in operand.args))

    def _angle(self, operand: Op, index: int) -> Operand | None:
        """The angle of a sine and cosine of which one changes its sign, or both do: one of two."""
        y, x = (self._part(one, index) for one in operand.args)
        if y is None or x is None or (y.signs and x.signs and y.signs != x.signs):
            return None
        plus = self._shared(Op("atan2", (y.plus, x.plus)))
        minus = self._shared(Op("select", _other_angle(plus, bool(y.signs), bool(x.signs))))
        sign = self._product(y.signs | x.signs, index)
        return Op("select", (self._shared(Op("gt", (0.0, sign))), minus, plus))


def _other_angle(angle: Operand, sine: bool, cosine: bool) -> tuple[Op, Operand, Operand]:
    """The angle in (-pi, pi] whose sine or cosine has the other sign, or both, as a condition, what it is
    where that holds, and what elsewhere."""
    if not cosine:
        return Op("gt", (angle, _BELOW_PI)), angle, Op("neg", (angle,))
    if not sine:
        below = Op("gt", (0.0, angle))
        return below, Op("sub", (-math.pi, angle)), Op("sub", (math.pi, angle))
    return Op("gt", (angle, 0.0)), Op("sub", (angle, math.pi)), Op("add", (angle, math.pi))


def _signs(op: str, signs: Sequence[Signs]) -> Signs | None:
    """The signs of an operation's value, or None where it has none of its own."""
    if op in ("mul", "div"):
        return reduce(xor, signs)
    if op in ("add", "sub"):
        return signs[0] if signs[0] == signs[1] else None
    if op in ("neg", "sin"):
        return signs[0]
    if op in ("abs", "cos"):
        return NONE
    return None if any(signs) else NONE


def _simple(op: str, args: tuple[Operand, ...]) -> Operand:
    """The operation, or what it comes to where a sign has become one."""
    if op == "neg" and args[0] == 1.0:
        return -1.0
    if op == "mul" and 1.0 in args:
        return args[1] if args[0] == 1.0 else args[0]
    return Op(op, args)
