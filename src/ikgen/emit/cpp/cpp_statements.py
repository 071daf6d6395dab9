"""The Program as C++ statements over packs of lanes: breadth first, without a branch in it.

The lanes of a level are the branches of all levels up to it. A level repeats what it needs of the
level before, so branch i of a level and lane p of the level before meet in lane `i * width + p`.
"""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence

from ikgen.emit.blanks import blank_functions
from ikgen.emit.cpp.cpp_language import CONSTANT, CPP, LINE, comment, number
from ikgen.emit.printer import expression
from ikgen.emit.solver_module import SolverModule
from ikgen.program.inputs import ArmAngle, HeldValue, PoseEntry, SeedValue
from ikgen.program.interpret import evaluate
from ikgen.program.liveness import live_names
from ikgen.program.margins import margin
from ikgen.program.ops import Op, Operand, operand_names, renamed
from ikgen.program.statements import Call, Comment, Let, Level, Require

__all__ = ["ProgramText"]


class ProgramText:
    """Statements of the solver's body, for a number `P` of poses that the template fixes."""

    def __init__(self, module: SolverModule) -> None:
        self.module = module
        self.program = module.program
        self.live = live_names(self.program)
        self.fixed = {one.name: one.value for one in self.program.parameters}
        for let in self.program.constants:
            self.fixed[let.name] = evaluate(let.value, self.fixed)
        self._fold_fixed_lets()
        self.lines: list[str] = []
        self.flags: dict[str, list[str]] = {"hit": [], "meeting": []}
        self.real = ""
        self._guards = 0
        self._folds = 0
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
        text = {p.name: number(p.value) for p in self.program.parameters if p.name in self.live}
        lets = [s for lv in self.program.levels for s in lv.body if isinstance(s, Let)]
        for let in (*self.program.constants, *lets):
            if let.name in self.fixed and let.name in self.live:
                text[let.name] = expression(CONSTANT, let.value)
        above = {*self.module.dh.symbols, *(f.name for f in blank_functions(self.module))}
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
            self._meeting(level, width, self.program.levels[index + 1 :])

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
            f"({call.routine.name}_branches, {arguments});"
        )
        for k, name in enumerate(call.names):
            if name in self.live:
                self._let(name, f"{roots}.value[{k}]")
        self._require(index, f"{roots}.found")
        self.flags["meeting"].append(f"{roots}.found")
        if self.module.plan is not None:
            self.flags["hit"].append(f"{roots}.open")

    def _body(self, index: int, level: Level) -> None:
        for s in level.body:
            if isinstance(s, Comment):
                self.lines += textwrap.wrap(
                    comment(s.text), LINE - 2, initial_indent="// ", subsequent_indent="// "
                )
            elif isinstance(s, Require):
                self._require(index, expression(CPP, s.condition, 3))
                if s.fold and len(self.module.held) == 1:
                    text = expression(CPP, margin(s.condition))
                    self._statement(f"rows.template fold<{self._folds}>({text});")
                    self._folds += 1
            elif s.name in self.live and s.name not in self.fixed:
                self._let(s.name, expression(CPP, self._in_lanes(s.value)))
                if s.name in self.program.singular:
                    self.flags["hit"].append(f"({self.real} & {s.name})" if self.real else s.name)

    def _in_lanes(self, operand: Operand) -> Operand:
        """The operand with constants under an arctangent as packs."""
        if not isinstance(operand, Op):
            return operand
        args = tuple(self._in_lanes(a) for a in operand.args)
        if operand.op == "atan2":
            args = tuple(
                Op("spread", (a,)) if operand_names(a) <= self.fixed.keys() else a for a in args
            )
        return Op(operand.op, args)

    def _require(self, index: int, condition: str) -> None:
        """The lanes in which all guards so far hold."""
        self._guards += 1
        name = f"real_{self._guards}"
        self._let(name, f"{self.real} & {condition}" if self.real else condition)
        self.real = name

    def _meeting(self, level: Level, width: int, inner: Sequence[Level]) -> None:
        """Whether the two branches of a level meet, which makes equal rows. What several signs decide is
        known at the `inner` level of the last: its rows are always compared."""
        if level.solved and any(level.solved == one.solved for one in inner):
            self.flags["meeting"].append(f"({level.sigma} > -2.0)")
        elif level.solved:
            names = ", ".join(level.solved)
            self.flags["meeting"].append(f"meeting<Policy, {width} * P>({names})")

    def _let(self, name: str, text: str) -> None:
        self._statement(f"const auto {name} = {text};")

    def _statement(self, text: str) -> None:
        self.lines += textwrap.wrap(
            text, LINE - 2, subsequent_indent="    ", break_long_words=False, break_on_hyphens=False
        )

    # -- inputs ---------------------------------------------------------------------------------

    def bindings(self) -> list[str]:
        """Lines that name the inputs: the pose's entries, the seed's and the held joints' variables."""
        program = self.program
        lines = [
            f"const auto {one.name} = pose.t[{one.row}][{one.column}];"
            for one in program.inputs_of(PoseEntry)
        ]
        for let in self.seed_lets():
            if let.name in self.lane_names:
                lines.append(f"const auto {let.name} = spread<1>(seed.{let.name});")
        for one in program.inputs_of(HeldValue):
            index = self.module.free_indices.index(one.joint)
            lines.append(f"const double {one.name} = held[{index}];")
        for angle in program.inputs_of(ArmAngle):
            lines.append(f"const double {angle.name} = held[{len(self.module.free_indices)}];")
        for let in program.prelude:
            if let not in self.seed_lets():
                text = expression(CONSTANT, let.value)
                shown = f"spread<1>({text})" if let.name in self.lane_names else text
                lines.append(f"const auto {let.name} = {shown};")
        return lines

    @property
    def lane_names(self) -> set[str]:
        """Names that statements over lanes read."""
        found: set[str] = set()
        for level in self.program.levels:
            arguments = level.call.arguments if level.call is not None else ()
            values = (s.value for s in level.body if isinstance(s, Let))
            conditions = (s.condition for s in level.body if isinstance(s, Require))
            for operand in (*arguments, *values, *conditions):
                found |= operand_names(operand)
        return found

    def seed_lets(self) -> list[Let]:
        """What of the prelude follows from the seed."""
        names = {one.name for one in self.program.inputs_of(SeedValue)}
        out = []
        for let in self.program.prelude:
            if operand_names(let.value) & names:
                names.add(let.name)
                out.append(let)
        return out

    def seed_members(self) -> list[tuple[str, str, str]]:
        """Name, value at q = 0 and text of what follows from a seed `q`, in order."""
        values = {one.name: 0.0 for one in self.program.inputs_of(SeedValue)}
        given = {one.name: f"q[{one.joint}]" for one in self.program.inputs_of(SeedValue)}
        members = []
        for let in self.seed_lets():
            values[let.name] = evaluate(let.value, values)
            text = expression(CONSTANT, renamed(let.value, given))
            members.append((let.name, number(values[let.name]), text))
        return members

    # -- results --------------------------------------------------------------------------------

    def joint_values(self) -> list[tuple[str, bool]]:
        """Per joint, base to tip, the text of its value, and whether that is one put inside the limits:
        none can be outside where they span a whole turn."""
        held = {one.name for one in self.program.inputs_of(HeldValue)}
        out = []
        for one in sorted(self.program.outputs, key=lambda output: output.joint):
            text = expression(CPP, one.value)
            if operand_names(one.value) <= held | self.fixed.keys():
                text = f"spread<1>({text})"
            out.append(self._placed(one.joint, text))
        return out

    def _placed(self, joint: int, value: str) -> tuple[str, bool]:
        limits = self.module.dh.joints[joint].limits
        half = 0.0 if joint in self.module.free_indices else 0.5 * self.module.period(joint)
        if math.isinf(limits.lower) and math.isinf(limits.upper):
            return value, False
        if half and limits.lower <= -half and limits.upper >= half:
            return value, False
        if half:
            return f"place<Policy>({joint}, {value}, range, kPeriod[{joint}])", True
        return f"clamp({joint}, {value}, range)", True


def _calls(operand: Operand) -> bool:
    """Whether an operand needs more than arithmetic, which a constexpr cannot have."""
    if not isinstance(operand, Op):
        return False
    return operand.op not in ("add", "sub", "mul", "div", "neg") or any(map(_calls, operand.args))
