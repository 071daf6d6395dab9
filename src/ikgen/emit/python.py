"""Emitter of the Python module: the Program as nested loops (scalar) and as arrays (batch)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

from ikgen.emit.module import SolverModule
from ikgen.emit.printer import Language, expression
from ikgen.emit.python_text import literal, words
from ikgen.emit.rendering import render
from ikgen.emit.symbols import blanks, frame_entries, pairs
from ikgen.ir.ops import Op, Operand, operand_names
from ikgen.ir.program import Comment, JointOutput, Let, Level, Program, Require

__all__ = ["emit_derivation", "emit_module"]

_INFIX = {
    "or": ("or", 1),
    "and": ("and", 2),
    "gt": (">", 4),
    "add": ("+", 5),
    "sub": ("-", 5),
    "mul": ("*", 6),
    "div": ("/", 6),
}


def _number(value: float) -> str:
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
        "abs": lambda x: f"abs({x})",
        "max": lambda a, b: f"max({a}, {b})",
        "min": lambda a, b: f"min({a}, {b})",
        "select": lambda c, a, b: f"({a} if {c} else {b})",
    },
    number=_number,
)

BATCH = Language(
    infix={**_INFIX, "or": ("|", 3), "and": ("&", 3)},
    prefix={"neg": ("-", 7), "not": ("~", 7)},
    calls={
        "sqrt": lambda x: f"np.sqrt(np.maximum({x}, 0.0))",
        "abs": lambda x: f"np.abs({x})",
        "max": lambda a, b: f"np.maximum({a}, {b})",
        "min": lambda a, b: f"np.minimum({a}, {b})",
        "select": lambda c, a, b: f"np.where({c}, {a}, {b})",
        "gt": lambda a, b: f"({a} > {b})",
        "or": lambda a, b: f"({a} | {b})",
        "and": lambda a, b: f"({a} & {b})",
        "not": lambda a: f"~{a}",
    },
    number=_number,
)


class _Derived(Protocol):
    @property
    def module(self) -> SolverModule: ...


def emit_derivation(derivation: _Derived) -> dict[str, str]:
    """File name -> text of the Python output."""
    module = derivation.module
    return {f"{module.name}_ik.py": emit_module(module)}


def emit_module(module: SolverModule) -> str:
    """The text of `<name>_ik.py`."""
    program = module.program
    joints = [_JointText.of(module, output) for output in program.outputs]
    return render(
        "python",
        "module.py.jinja",
        m=module,
        joints=module.dh.joints,
        lower=[_number(j.limits.lower) for j in module.dh.joints],
        upper=[_number(j.limits.upper) for j in module.dh.joints],
        parameters=_parameters(module),
        blanks=blanks(module),
        constants=[(c.name, expression(SCALAR, c.value)) for c in program.constants],
        scalar=_scalar(module, joints),
        batch=_batch(module, joints),
        routines=sorted({lv.call.routine for lv in program.levels if lv.call is not None}),
        used=_used_inputs(program),
        seeds=_seed_rows(module),
        shape=[level.branches for level in program.levels[1:]],
        frames=[
            [[expression(SCALAR, x) for x in row] for row in F] for F in frame_entries(module.dh)
        ],
        rows=[(row.driver, row.revolute, row.scale, row.offset.value) for row in module.dh.rows],
        number=_number,
        literal=literal,
        words=words,
        beside=[[[_number(float(x)) for x in row] for row in D] for D in module.beside],
        orientation=module.reads.orientation,
        entries=module.reads.entries,
        size=module.size,
    )


def _parameters(module: SolverModule) -> list[tuple[str, str]]:
    """Name and text of the arm's constants but those to be filled in."""
    angles = {f"{f}_{n}": f"{f}({n})" for n in pairs(module) for f in ("cos", "sin")}
    given = [(n, v) for n, v in module.program.parameters if n not in module.dh.symbols]
    plain = [(n, _number(v)) for n, v in given if n not in angles]
    return [*angles.items(), *plain]


def _used_inputs(program: Program) -> list[str]:
    used: set[str] = set()
    for level in program.levels:
        if level.call is not None:
            for a in level.call.arguments:
                used |= operand_names(a)
        for statement in level.body:
            if isinstance(statement, Let):
                used |= operand_names(statement.value)
            elif isinstance(statement, Require):
                used |= operand_names(statement.condition)
    for output in program.outputs:
        used |= operand_names(output.cosine) | operand_names(output.sine)
    return [name for name in program.inputs if name in used]


def _seed_rows(module: SolverModule) -> list[tuple[int, bool, float, float]]:
    """Per joint: index, revolute, scale and offset of its first row."""
    out = []
    for j in range(module.dh.dof):
        row = module.first_row(j)
        out.append((j, row.revolute, row.scale, row.offset.value))
    return out


@dataclass(frozen=True, slots=True)
class _JointText:
    """How a joint's value follows from its output: `scalar` and `batch` are expressions."""

    joint: int
    output: JointOutput
    scale: float
    offset: float
    held: str

    @staticmethod
    def of(module: SolverModule, output: JointOutput) -> _JointText:
        row = module.first_row(output.joint)
        held = f"held[{module.free.index(output.joint)}]" if output.joint in module.free else ""
        return _JointText(output.joint, output, row.scale, row.offset.value, held)

    def text(self, language: Language, arctangent: str) -> str:
        """`scale * (v - offset)` with offsets of whole right angles folded into the pair."""
        o = self.output
        if self.held:
            return self.held if language is SCALAR else "np.zeros(1)"
        if not o.revolute:
            value: Operand = o.cosine
            if self.offset:
                value = Op("sub", (value, self.offset))
            if self.scale != 1.0:
                value = Op("div", (value, self.scale))
            return expression(language, value)
        turns = self.offset / (math.pi / 2)
        cosine, sine = o.cosine, o.sine
        rest = self.offset
        if abs(turns - round(turns)) < 1e-12:
            cosine, sine = _quarter_turns(cosine, sine, round(turns) % 4)
            rest = 0.0
        if self.scale == -1.0 and rest == 0.0:
            sine = _negated(sine)
        angle = f"{arctangent}({expression(language, sine)}, {expression(language, cosine)})"
        if rest:
            angle = f"{angle} - {expression(language, rest, 6)}"
        if self.scale == 1.0 or (self.scale == -1.0 and not rest):
            return angle
        return f"({angle}) / {expression(language, self.scale, 7)}"


def _negated(operand: Operand) -> Operand:
    if isinstance(operand, Op) and operand.op == "neg":
        return operand.args[0]
    return Op("neg", (operand,))


def _quarter_turns(c: Operand, s: Operand, turns: int) -> tuple[Operand, Operand]:
    """Cosine and sine of an angle minus a number of right angles."""
    if turns == 1:
        return s, _negated(c)
    if turns == 2:
        return _negated(c), _negated(s)
    if turns == 3:
        return _negated(s), c
    return c, s


def _home_levels(program: Program) -> dict[str, int]:
    """The level that defines each name."""
    home: dict[str, int] = {}
    for index, level in enumerate(program.levels):
        if level.sigma is not None:
            home[level.sigma] = index
        if level.call is not None:
            home |= dict.fromkeys(level.call.names, index)
        for statement in level.body:
            if isinstance(statement, Let):
                home[statement.name] = index
    return home


def _level_of(output: JointOutput, home: dict[str, int]) -> int:
    names = operand_names(output.cosine) | operand_names(output.sine)
    return max((home.get(n, 0) for n in names), default=0)


def _scalar(module: SolverModule, joints: list[_JointText]) -> list[str]:
    """Lines of the nested loops, indented from the function's body on."""
    program = module.program
    home = _home_levels(program)
    lines: list[str] = []
    for index, level in enumerate(program.levels):
        pad = "    " * index
        if index:
            lines.append("    " * (index - 1) + _loop(level))
        leave = "continue" if index else "return rows, hit"
        for statement in level.body:
            if isinstance(statement, Comment):
                lines.append(f"{pad}# {statement.text}")
            elif isinstance(statement, Let):
                lines.append(f"{pad}{statement.name} = {expression(SCALAR, statement.value)}")
                if statement.name in program.singular:
                    lines.append(f"{pad}hit = hit or {statement.name}")
            else:
                lines.append(f"{pad}if not ({expression(SCALAR, statement.condition)}):")
                lines.append(f"{pad}    {leave}")
        for joint in joints:
            if _level_of(joint.output, home) == index:
                lines.append(f"{pad}q{joint.joint + 1} = {joint.text(SCALAR, 'atan2')}")
    pad = "    " * (len(program.levels) - 1)
    row = ", ".join(f"q{j.joint + 1}" for j in joints) + ("," if len(joints) == 1 else "")
    flag = " or ".join(program.singular) or "False"
    if module.polish == "some":
        rough = " or ".join([*program.singular, *(f"{r} > _ROUGH" for r in program.residuals)])
        rough = rough or "False"
        lines.append(f"{pad}rows.append((({row}), {flag}, {rough}))")
    else:
        lines.append(f"{pad}rows.append((({row}), {flag}))")
    return lines


def _loop(level: Level) -> str:
    if level.call is not None:
        arguments = ", ".join(expression(SCALAR, a) for a in level.call.arguments)
        return f"for {', '.join(level.call.names)} in _{level.call.routine}_branches({arguments}):"
    return f"for {level.sigma} in (1.0, -1.0):"


def _batch(module: SolverModule, joints: list[_JointText]) -> list[str]:
    """Lines of the array program: the axes before the last are the branches of the levels."""
    program = module.program
    lines: list[str] = []
    depth = len(program.levels) - 1
    for index, level in enumerate(program.levels):
        if level.sigma is not None:
            lines.append(f"{level.sigma} = _branch_axis({index - 1}, {depth})")
        if level.call is not None:
            arguments = ", ".join(expression(BATCH, a) for a in level.call.arguments)
            names = ", ".join(level.call.names)
            call = f"_{level.call.routine}_lanes(({arguments}), {index - 1})"
            lines.append(f"{names}, found = {call}")
            lines.append("valid = valid & found")
        for statement in level.body:
            if isinstance(statement, Comment):
                lines.append(f"# {statement.text}")
            elif isinstance(statement, Let):
                lines.append(f"{statement.name} = {expression(BATCH, statement.value)}")
            else:
                lines.append(f"valid = valid & {expression(BATCH, statement.condition, 9)}")
    lines.append("q = (")
    lines += [f"    {joint.text(BATCH, 'np.arctan2')}," for joint in joints]
    lines.append(")")
    flag = " | ".join(program.singular)
    if module.polish == "some":
        rough = " | ".join([*program.singular, *(f"({r} > _ROUGH)" for r in program.residuals)])
        lines.append(f"rough: NDArray[np.bool_] = {rough or 'np.zeros(1, dtype=bool)'}")
    lines.append(f"singular: NDArray[np.bool_] = {flag or 'np.zeros(1, dtype=bool)'}")
    return lines
