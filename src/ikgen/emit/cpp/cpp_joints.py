"""Joint values in C++: from the Program's outputs to the file's joints, and from a seed to its inputs."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ikgen.emit.cpp.cpp_language import number
from ikgen.emit.cpp.cpp_statements import ProgramText
from ikgen.emit.solver_module import SolverModule
from ikgen.program.ops import Op, Operand
from ikgen.program.statements import JointOutput

__all__ = ["JointValue", "Seed"]


@dataclass(frozen=True, slots=True)
class Seed:
    """One input that a singular pose takes from the seed: `home` is its value at q = 0."""

    name: str
    joint: int
    function: str
    home: str

    @staticmethod
    def of(module: SolverModule, name: str) -> Seed:
        joint = int(name[6:]) - 1
        offset = module.first_row(joint).offset.value
        function = {"c": "std::cos", "s": "std::sin", "d": ""}[name[5]]
        home = {"c": math.cos, "s": math.sin, "d": float}[name[5]](offset)
        return Seed(name, joint, function, number(home))


@dataclass(frozen=True, slots=True)
class JointValue:
    """One joint's value: its text, and the function that puts it inside the limits ("": none can be
    outside, since they span a whole turn)."""

    name: str
    text: str
    placing: str

    @staticmethod
    def of(module: SolverModule, text: ProgramText, output: JointOutput) -> JointValue:
        j = output.joint
        limits = module.dh.joints[j].limits
        placing = "place" if output.revolute and j not in module.free else "clamp"
        if placing == "place" and limits.lower <= -math.pi and limits.upper >= math.pi:
            placing = ""
        if math.isinf(limits.lower) and math.isinf(limits.upper):
            placing = ""
        return JointValue(f"q{j + 1}", _joint_value(module, text, output), placing)


def _joint_value(module: SolverModule, text: ProgramText, output: JointOutput) -> str:
    """The joint's value `(v - offset) / scale` from its output.

    For angles the pair is turned by the offset and mirrored instead, so that the value of the one
    arctangent is already in (-pi, pi].
    """
    if output.joint in module.free:
        return f"spread<1>(held[{module.free.index(output.joint)}])"
    row = module.first_row(output.joint)
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
