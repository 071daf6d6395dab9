"""The Program as C++ statements over packs of lanes: breadth first, without a branch in it.

The lanes of a level are the branches of all levels up to it. A level repeats what it needs of the
level before, so branch i of a level and lane p of the level before meet in lane `i * width + p`.
"""

from __future__ import annotations

import textwrap

from ikgen.emit.cpp.cpp_language import CONSTANT, CPP, LINE, comment, number
from ikgen.emit.printer import expression
from ikgen.emit.solver_module import SolverModule
from ikgen.emit.symbolic_frames import pairs
from ikgen.program.interpret import evaluate
from ikgen.program.liveness import live_names
from ikgen.program.ops import Op, Operand, operand_names
from ikgen.program.statements import Call, Comment, JointOutput, Let, Level, Require

__all__ = ["ProgramText"]


class ProgramText:
    """Statements of the solver's body, for a number `P` of poses that the template fixes."""

    def __init__(self, module: SolverModule) -> None:
        self.module = module
        self.program = module.program
        self.live = live_names(self.program)
        self.fixed: dict[str, float] = dict(self.program.parameters)
        for let in self.program.constants:
            self.fixed[let.name] = evaluate(let.value, self.fixed)
        self._fold_fixed_lets()
        self.lines: list[str] = []
        self.flags: dict[str, list[str]] = {"hit": [], "alike": []}
        self.real = ""
        self._guards = 0
        self._write()

    # -- constants ------------------------------------------------------------------------------

    def _fold_fixed_lets(self) -> None:
        """A value of constants alone is a constant."""
        for level in self.program.levels:
            for s in level.body:
                if isinstance(s, Let) and operand_names(s.value) <= self.fixed.keys():
                    self.fixed[s.name] = evaluate(s.value, self.fixed)

    @property
    def constants(self) -> list[tuple[str, str]]:
        """Name and text of every constant in use, parameters first; of a table without numbers those
        that follow from the constants to be filled in."""
        if self.module.dh.symbols:
            return self._written_constants()
        text = dict.fromkeys(self.fixed, "")
        for let in self.program.constants:
            if not _calls(let.value):
                text[let.name] = expression(CPP, let.value)
        return [(n, text[n] or number(v)) for n, v in self.fixed.items() if n in self.live]

    def _written_constants(self) -> list[tuple[str, str]]:
        angles = {f"{f}_{n}" for n in pairs(self.module) for f in ("cos", "sin")}
        text = {n: number(v) for n, v in self.program.parameters if n in self.live}
        lets = [s for lv in self.program.levels for s in lv.body if isinstance(s, Let)]
        for let in (*self.program.constants, *lets):
            if let.name in self.fixed and let.name in self.live:
                text[let.name] = expression(CONSTANT, let.value)
        above = {*self.module.dh.symbols, *angles}
        return [(n, t) for n, t in text.items() if n not in above]

    # -- statements -----------------------------------------------------------------------------

    def _write(self) -> None:
        width = 1
        for index, level in enumerate(self.program.levels):
            if index:
                self.lines.append("")
                self._fork(index, level, width)
            width *= level.branches
            self._body(index, level)
            self._alike(level, width)

    def _fork(self, index: int, level: Level, width: int) -> None:
        if level.call is not None:
            self._call(index, level.call, level.branches, width)
        elif level.sigma is not None:
            self._let(level.sigma, f"signs<{level.branches * width} * P>()")

    def _call(self, index: int, call: Call, branches: int, width: int) -> None:
        arguments = ", ".join(expression(CPP, a) for a in call.arguments)
        roots = f"roots_{index}"
        self._statement(
            f"const auto {roots} = roots_of<{branches}, {len(call.names)}, {width} * P>"
            f"({call.routine}_branches, {arguments});"
        )
        for k, name in enumerate(call.names):
            if name in self.live:
                self._let(name, f"{roots}.value[{k}]")
        self._require(index, f"{roots}.found")
        self.flags["alike"].append(f"{roots}.found")

    def _body(self, index: int, level: Level) -> None:
        for s in level.body:
            if isinstance(s, Comment):
                self.lines += textwrap.wrap(
                    comment(s.text), LINE - 2, initial_indent="// ", subsequent_indent="// "
                )
            elif isinstance(s, Require):
                self._require(index, expression(CPP, s.condition, 3))
            elif s.name in self.live and s.name not in self.fixed:
                self._let(s.name, expression(CPP, s.value))
                if s.name in self.program.singular:
                    self.flags["hit"].append(f"({self.real} & {s.name})" if self.real else s.name)

    def _require(self, index: int, condition: str) -> None:
        """The lanes in which all guards so far hold."""
        self._guards += 1
        name = f"real_{self._guards}"
        self._let(name, f"{self.real} & {condition}" if self.real else condition)
        self.real = name

    def _alike(self, level: Level, width: int) -> None:
        """Whether the two branches of a level meet, which makes equal rows."""
        if level.sigma is None:
            return
        suffix = level.sigma.split("_", 1)[-1]
        names = [n for n in (f"c{suffix}", f"s{suffix}", f"d{suffix}") if n in self.live]
        if names:
            self.flags["alike"].append(f"meeting<Policy, {width} * P>({', '.join(names)})")

    def _let(self, name: str, text: str) -> None:
        self._statement(f"const auto {name} = {text};")

    def _statement(self, text: str) -> None:
        self.lines += textwrap.wrap(
            text, LINE - 2, subsequent_indent="    ", break_long_words=False, break_on_hyphens=False
        )

    # -- results --------------------------------------------------------------------------------

    def pack(self, operand: Operand) -> str:
        """An output operand as a pack, also where it is a constant."""
        text = expression(CPP, operand)
        fixed = operand_names(operand) <= self.fixed.keys()
        return f"spread<1>({text})" if fixed else text

    def outputs(self) -> tuple[JointOutput, ...]:
        """The joints' outputs, base to tip."""
        return tuple(sorted(self.program.outputs, key=lambda o: o.joint))


def _calls(operand: Operand) -> bool:
    """Whether an operand needs more than arithmetic, which a constexpr cannot have."""
    if not isinstance(operand, Op):
        return False
    return operand.op not in ("add", "sub", "mul", "div", "neg") or any(map(_calls, operand.args))
