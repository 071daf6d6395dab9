"""Joint values in the text of the Python module."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ikgen.emit.printer import Language, expression
from ikgen.emit.python.python_language import SCALAR
from ikgen.emit.solver_module import SolverModule
from ikgen.program.ops import Op, Operand
from ikgen.program.statements import JointOutput

__all__ = ["JointText"]


@dataclass(frozen=True, slots=True)
class JointText:
    """How a joint's value follows from its output: `scalar` and `batch` are expressions."""

    joint: int
    output: JointOutput
    scale: float
    offset: float
    held: str

    @staticmethod
    def of(module: SolverModule, output: JointOutput) -> JointText:
        """The text of one of the module's outputs."""
        row = module.first_row(output.joint)
        held = f"held[{module.free.index(output.joint)}]" if output.joint in module.free else ""
        return JointText(output.joint, output, row.scale, row.offset.value, held)

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
