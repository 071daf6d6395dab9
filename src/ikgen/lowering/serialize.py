"""From placed expressions to named statements: what is used once is written where it is used."""

from __future__ import annotations

from collections import Counter

from ikgen.algebra.expression import Expr
from ikgen.lowering.frames import file_frames
from ikgen.lowering.placement import Placement, Requirement
from ikgen.program.ops import BOOLEAN, Op, Operand
from ikgen.program.remarks import remarked, with_remarks
from ikgen.program.statements import (
    Call,
    Comment,
    Constant,
    JointOutput,
    Let,
    Level,
    Program,
    Require,
    Statement,
)

__all__ = ["serialize"]

LONGEST_INLINE = 9
"""An expression of more operations gets a name of its own."""


class _Serializer:
    def __init__(self, work: Placement, values: list[tuple[int, Expr]]) -> None:
        self.work = work
        self.uses: Counter[int] = Counter()
        self.names: dict[int, str] = dict(work.names)
        self.kept: set[int] = set()
        self.parameters: dict[str, Constant] = {}
        self.constants: list[Let] = []
        self.inline: dict[int, tuple[Operand, int]] = {}
        self.home: dict[int, int] = {}
        self._temporaries = 0
        self._live: set[int] = set()
        self._written: set[int] = set()
        self._mark(values)

    # -- which nodes are needed, and how often ---------------------------------------------------

    def _mark(self, values: list[tuple[int, Expr]]) -> None:
        for index, level in enumerate(self.work.levels):
            if level.call is not None:
                for e in level.call[1]:
                    self._need(e, index - 1)
            for item in level.items:
                if isinstance(item, Requirement):
                    self._need(item.condition, index)
        work, last = self.work, len(self.work.levels) - 1
        for _, e in values:
            self._need(e, last, keep=True)
        for e in (*work.singular, *work.hidden, *work.doubts, *work.residuals):
            self._need(e, last, keep=True)

    def _need(self, node: Expr, level: int, *, keep: bool = False) -> None:
        """Count a use at a level; a use at a deeper level than the node's own gives it a name."""
        node = self.work.canonical(node)
        if node.is_const:
            return
        self.uses[node.id] += 1
        if keep or (self.work.level(node) < level and not node.is_fixed):
            self.kept.add(node.id)
        if node.id in self._live:
            return
        self._live.add(node.id)
        home = self.work.level(node)
        definition = self.work.definition.get(node.id)
        for a in node.args if definition is None else (definition,):
            self._need(a, home)

    # -- writing --------------------------------------------------------------------------------

    def name(self, node: Expr) -> str:
        if node.id not in self.names:
            self._temporaries += 1
            self.names[node.id] = f"x{self._temporaries}"
        return self.names[node.id]

    def operand(self, node: Expr) -> Operand:
        """A name, a number, or the nested operation itself."""
        node = self.work.canonical(node)
        if node.is_const:
            return node.value
        if node.op == "param":
            self.parameters[node.name] = Constant(node.name, node.value, node.function)
            return node.name
        if node.is_fixed:
            return self._constant(node)
        found = self.inline.get(node.id)
        return found[0] if found is not None else self.name(node)

    def _constant(self, node: Expr) -> str:
        if node.id not in self.names:
            value = Op(node.op, tuple(self.operand(a) for a in node.args))
            self.names[node.id] = f"k{len(self.constants) + 1}"
            self.constants.append(Let(self.names[node.id], value))
        return self.names[node.id]

    def statement(self, node: Expr) -> Let | None:
        """The node's statement, or None where it is written inline."""
        node = self.work.canonical(node)
        if node.id not in self._live or node.id in self._written or node.is_fixed:
            return None
        definition = self.work.definition.get(node.id)
        if definition is None and not node.args:
            return None
        if definition is not None:
            value, size = self.operand(definition), self._size(definition)
        else:
            value = Op(node.op, tuple(self.operand(a) for a in node.args))
            size = 1 + sum(self._size(a) for a in node.args)
        named = node.id in self.work.names or node.id in self.kept or self.uses[node.id] > 1
        self._written.add(node.id)
        if not named and size <= LONGEST_INLINE:
            self.inline[node.id] = (value, size)
            return None
        return Let(self.name(node), value, node.op in BOOLEAN)

    def _size(self, node: Expr) -> int:
        found = self.inline.get(self.work.canonical(node).id)
        return found[1] if found is not None else 0

    def level(self, index: int) -> Level:
        level = self.work.levels[index]
        body: list[Statement] = []
        for item in level.items:
            if isinstance(item, Comment):
                body.append(item)
            elif isinstance(item, Requirement):
                body.append(Require(self.operand(item.condition), item.fold))
            else:
                let = self.statement(item)
                if let is not None:
                    body.append(let)
        call = None
        if level.call is not None:
            routine, arguments, atoms = level.call
            call = Call(
                routine,
                tuple(self.operand(a) for a in arguments),
                tuple(self.name(a) for a in atoms),
            )
        sigma = None if level.sigma is None else self.name(level.sigma)
        solved = tuple(self.name(atom) for atom in level.solved if atom.id in self._live)
        return Level(level.branches, sigma, call, with_remarks(remarked(body)), solved)


def serialize(work: Placement, values: list[tuple[int, Expr]]) -> Program:
    """The Program of a finished lowering."""
    s = _Serializer(work, values)
    levels = tuple(s.level(i) for i in range(len(work.levels)))
    outputs = tuple(JointOutput(j, s.operand(e)) for j, e in values)
    singular = tuple(str(s.operand(e)) for e in (*work.singular, *work.hidden))
    residuals = tuple(str(s.operand(e)) for e in work.residuals)
    return Program(
        work.dh.robot,
        tuple(s.parameters.values()),
        tuple(s.constants),
        tuple(work.inputs),
        tuple(work.prelude),
        levels,
        outputs,
        singular,
        residuals,
        file_frames(work.dh),
        doubts=tuple(str(s.operand(e)) for e in work.doubts),
    )
