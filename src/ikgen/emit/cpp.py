"""Emitter of the C++ header, and of the small CMake package around it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ikgen.emit.cpp_program import ProgramText, number, used_inputs
from ikgen.emit.module import SolverModule
from ikgen.emit.rendering import render
from ikgen.errors import UsageError
from ikgen.ir.ops import Op, Operand
from ikgen.ir.program import JointOutput
from ikgen.model.dh import DHRow

__all__ = ["emit", "emit_derivation", "emit_header", "emit_package"]

ROUGH = 1e-20
"""Squared error of a row above which it takes Newton steps."""

_INLINE = "[[gnu::always_inline]] inline"

_ORIENTATION = {
    "pose": "rotation",
    "position": "",
    "position-direction": "direction",
    "position-yaw": "yaw",
    "rotation": "rotation",
    "direction": "direction",
}
"""What a task reads of the rotation."""


class _Derived(Protocol):
    @property
    def module(self) -> SolverModule: ...


def emit_derivation(derivation: _Derived) -> dict[str, str]:
    """File name -> text of the C++ output."""
    return emit(derivation.module)


def emit(module: SolverModule) -> dict[str, str]:
    """File name -> text of the C++ output."""
    return {f"{module.name}_ik.hpp": emit_header(module)}


def emit_package(module: SolverModule) -> dict[str, str]:
    """Relative path -> text: the header as a CMake package with an example and a README."""
    header = f"include/{module.name}_ik.hpp"
    files = ("CMakeLists.txt", "example.cpp", "README.md", "config.cmake.in")
    rename = {"config.cmake.in": f"cmake/{module.name}_ikConfig.cmake.in"}
    out = {header: emit_header(module)}
    for file in files:
        text = render("cpp", f"package/{file}.jinja", m=module, name=f"{module.name}_ik")
        out[rename.get(file, file)] = text
    return out


def emit_header(module: SolverModule) -> str:
    """The text of `<name>_ik.hpp`.

    Raises UsageError for a Program whose levels have a number of branches that is no power of two.
    """
    program = module.program
    branches = [level.branches for level in program.levels[1:]]
    if any(n & (n - 1) for n in branches):
        raise UsageError(f"the C++ emitter needs levels of 2, 4, ... branches, not {branches}")
    text = ProgramText(module)
    inputs = used_inputs(program)
    return render(
        "cpp",
        "header.hpp.jinja",
        m=module,
        namespace=f"{module.name}_ik",
        inline=_INLINE,
        orientation=_ORIENTATION[module.task],
        reads_position="position" in module.task or module.task == "pose",
        joints=module.dh.joints,
        lower=[number(j.limits.lower) for j in module.dh.joints],
        upper=[number(j.limits.upper) for j in module.dh.joints],
        far=any(j.limits.lower > math.pi or j.limits.upper < -math.pi for j in module.dh.joints),
        first_rows=[_first_row(module, j) for j in range(module.dh.dof)],
        text=text,
        entries=[name for name in inputs if name.startswith("t")],
        seeds=[_Seed.of(module, name) for name in inputs if name.startswith("seed_")],
        held=[name for name in inputs if name[0] in "csd" and name[1:].isdigit()],
        values=[_JointValue.of(module, text, output) for output in text.outputs()],
        rough=_rough(module),
        order=_depth_first(branches),
        routines=sorted({lv.call.routine for lv in program.levels if lv.call is not None}),
        frames=[[[number(float(x)) for x in row] for row in F[:3]] for F in module.dh.file_frames],
        size=number(_arm_size(module)),
        free_defaults=[number(x) for x in module.free_defaults],
        number=number,
    )


def _arm_size(module: SolverModule) -> float:
    return max(1.0, *(float(np.abs(F[:3, 3]).max()) for F in module.dh.file_frames))


def _first_row(module: SolverModule, joint: int) -> DHRow:
    return next(row for row in module.dh.rows if row.driver == joint)


def _depth_first(branches: list[int]) -> list[int]:
    """Lane of each row, depth first: branch i of a level adds i times the width before it."""
    lanes, width = [0], 1
    for n in branches:
        lanes = [lane + i * width for lane in lanes for i in range(n)]
        width *= n
    return lanes


@dataclass(frozen=True, slots=True)
class _Seed:
    """One input that a singular pose takes from the seed: `home` is its value at q = 0."""

    name: str
    joint: int
    function: str
    home: str

    @staticmethod
    def of(module: SolverModule, name: str) -> _Seed:
        joint = int(name[6:]) - 1
        offset = _first_row(module, joint).offset.value
        function = {"c": "std::cos", "s": "std::sin", "d": ""}[name[5]]
        home = {"c": math.cos, "s": math.sin, "d": float}[name[5]](offset)
        return _Seed(name, joint, function, number(home))


def _rough(module: SolverModule) -> str:
    """Condition under which a row takes Newton steps."""
    program = module.program
    if module.polish == "all":
        return "(spread<1>(1.0) > 0.0)"
    return " | ".join([*program.singular, *(f"({r} > {ROUGH})" for r in program.residuals)])


@dataclass(frozen=True, slots=True)
class _JointValue:
    """One joint's value: its text, and the function that puts it inside the limits ("": none can be
    outside, since they span a whole turn)."""

    name: str
    text: str
    placing: str

    @staticmethod
    def of(module: SolverModule, text: ProgramText, output: JointOutput) -> _JointValue:
        j = output.joint
        limits = module.dh.joints[j].limits
        placing = "place" if output.revolute and j not in module.free else "clamp"
        if placing == "place" and limits.lower <= -math.pi and limits.upper >= math.pi:
            placing = ""
        if math.isinf(limits.lower) and math.isinf(limits.upper):
            placing = ""
        return _JointValue(f"q{j + 1}", _joint_value(module, text, output), placing)


def _joint_value(module: SolverModule, text: ProgramText, output: JointOutput) -> str:
    """The joint's value `(v - offset) / scale` from its output.

    For angles the pair is turned by the offset and mirrored instead, so that the value of the one
    arctangent is already in (-pi, pi].
    """
    if output.joint in module.free:
        return f"spread<1>(held[{module.free.index(output.joint)}])"
    row = _first_row(module, output.joint)
    offset, scale = row.offset.value, row.scale
    if not output.revolute:
        value = _plus(output.cosine, -offset)
        return text.pack(value if scale == 1.0 else _times(1.0 / scale, value))
    c, s = output.cosine, output.sine
    co, so = _exact(math.cos(offset)), _exact(math.sin(offset))
    cosine = _sum(_times(co, c), _times(so, s))
    sine = _sum(_times(co, s), _times(-so, c))
    if scale == -1.0:
        sine = _sum(_times(so, c), _times(-co, s))
    angle = f"angle({text.pack(sine)}, {text.pack(cosine)})"
    return angle if abs(scale) == 1.0 else f"{angle} * {number(1.0 / scale)}"


def _exact(x: float) -> float:
    """0 and ±1 without the round-off of pi."""
    return float(round(x)) if abs(x - round(x)) < 1e-15 else x


def _times(k: float, x: Operand) -> Operand:
    if k == 0.0:
        return 0.0
    if k == 1.0:
        return x
    if k == -1.0:
        return x.args[0] if isinstance(x, Op) and x.op == "neg" else Op("neg", (x,))
    return Op("mul", (k, x))


def _sum(a: Operand, b: Operand) -> Operand:
    if a == 0.0:
        return b
    return a if b == 0.0 else Op("add", (a, b))


def _plus(a: Operand, k: float) -> Operand:
    return a if k == 0.0 else Op("add", (a, k))
