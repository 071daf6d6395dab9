"""The Program as Python: nested loops over floats, and one pass over arrays."""

from __future__ import annotations

from ikgen.emit.printer import expression
from ikgen.emit.python.python_joints import JointText
from ikgen.emit.python.python_language import BATCH, SCALAR
from ikgen.emit.solver_module import SolverModule
from ikgen.program.ops import operand_names
from ikgen.program.statements import Comment, JointOutput, Let, Level, Program

__all__ = ["batch_lines", "scalar_lines"]


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


def scalar_lines(module: SolverModule, joints: list[JointText]) -> list[str]:
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
    rough = "True"
    if module.polish == "some" and module.plan is None:
        rough = " or ".join([*program.singular, *(f"{r} > _ROUGH" for r in program.residuals)])
    lines.append(f"{pad}rows.append((({row}), {flag}, {rough or 'False'}))")
    return lines


def _loop(level: Level) -> str:
    if level.call is not None:
        arguments = ", ".join(expression(SCALAR, a) for a in level.call.arguments)
        return f"for {', '.join(level.call.names)} in _{level.call.routine}_branches({arguments}):"
    return f"for {level.sigma} in (1.0, -1.0):"


def batch_lines(module: SolverModule, joints: list[JointText]) -> list[str]:
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
    rough = "np.ones(1, dtype=bool)"
    if module.polish == "some":
        rough = " | ".join([*program.singular, *(f"({r} > _ROUGH)" for r in program.residuals)])
    lines.append(f"rough: NDArray[np.bool_] = {rough or 'np.zeros(1, dtype=bool)'}")
    lines.append(f"singular: NDArray[np.bool_] = {flag or 'np.zeros(1, dtype=bool)'}")
    return lines
