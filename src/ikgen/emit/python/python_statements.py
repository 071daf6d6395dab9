"""The Program as Python: nested loops over floats, and one pass over arrays."""

from __future__ import annotations

from ikgen.emit.printer import expression
from ikgen.emit.python.python_language import BATCH, SCALAR
from ikgen.emit.solver_module import SolverModule
from ikgen.program.inputs import ArmAngle, HeldValue, PoseEntry, SeedValue
from ikgen.program.margins import margin
from ikgen.program.ops import renamed
from ikgen.program.statements import Comment, Let, Level, Program, Require, Statement

__all__ = ["batch_lines", "scalar_lines"]


def scalar_lines(module: SolverModule) -> list[str]:
    """Lines of the nested loops, indented from the function's body on. They read `q0` (the seed's joint
    values), `held` (those of held joints) and the pose's entries, and append to `rows`."""
    program = module.program
    given = {one.name: f"q0[{one.joint}]" for one in program.inputs_of(SeedValue)}
    lines = []
    for one in program.inputs_of(HeldValue):
        lines.append(f"{one.name} = held[{module.free_indices.index(one.joint)}]")
    for angle in program.inputs_of(ArmAngle):
        lines.append(f"{angle.name} = held[{len(module.free_indices)}]")
    for let in program.prelude:
        lines.append(f"{let.name} = {expression(SCALAR, renamed(let.value, given))}")
    for index, level in enumerate(program.levels):
        pad = "    " * index
        if index:
            lines.append("    " * (index - 1) + _loop(level))
        leave = "continue" if index else "return rows, doubt"
        for statement in level.body:
            lines += [pad + line for line in _scalar_statement(program, statement, leave)]
    pad = "    " * (len(program.levels) - 1)
    return [*lines, *(pad + line for line in _scalar_row(module))]


def _scalar_statement(program: Program, statement: Statement, leave: str) -> list[str]:
    if isinstance(statement, Comment):
        return [f"# {statement.text}"]
    if isinstance(statement, Require):
        return [f"if not ({expression(SCALAR, statement.condition)}):", f"    {leave}"]
    lines = [f"{statement.name} = {expression(SCALAR, statement.value)}"]
    if statement.name in program.singular:
        lines.append(f"doubt = doubt or {statement.name}")
    return lines


def _scalar_row(module: SolverModule) -> list[str]:
    """The innermost statements: joint values, and what is known of the row."""
    program = module.program
    values = [expression(SCALAR, one.value) for one in program.outputs]
    row = ", ".join(values) + ("," if len(values) == 1 else "")
    rough = "True"
    if module.tells_rough:
        rough = " or ".join([*program.singular, *(f"{r} > _ROUGH" for r in program.residuals)])
    lines = [f"rows.append((({row}), {rough or 'False'}))"]
    return [f"doubt = doubt or {' or '.join(program.doubts)}", *lines] if program.doubts else lines


def _loop(level: Level) -> str:
    if level.call is not None:
        arguments = ", ".join(expression(SCALAR, a) for a in level.call.arguments)
        return f"for {', '.join(level.call.names)} in _{level.call.routine.name}_branches({arguments}):"
    return f"for {level.sigma} in (1.0, -1.0):"


def batch_lines(module: SolverModule) -> list[str]:
    """Lines of the array program: the axes before the last are the branches of the levels. They read `T`
    (N, 4, 4), `q0` and `held` (N, k) in lanes of the shape `lane`, and set `q`, `valid`, `singular`,
    `rough` and `doubt`."""
    program = module.program
    lines = _batch_inputs(module)
    depth = len(program.levels) - 1
    for index, level in enumerate(program.levels):
        if level.sigma is not None:
            lines.append(f"{level.sigma} = _branch_axis({index - 1}, {depth})")
        if level.call is not None:
            arguments = ", ".join(expression(BATCH, a) for a in level.call.arguments)
            names = ", ".join(level.call.names)
            call = f"_{level.call.routine.name}_lanes(({arguments}), {index - 1})"
            lines.append(f"{names}, found = {call}")
            lines.append("valid = valid & found")
        for statement in level.body:
            if isinstance(statement, Comment):
                lines.append(f"# {statement.text}")
            elif isinstance(statement, Let):
                lines.append(f"{statement.name} = {expression(BATCH, statement.value)}")
                if statement.name in program.singular:
                    lines.append(f"singular = singular | valid & {statement.name}")
            else:
                lines.append(f"valid = valid & {expression(BATCH, statement.condition, 9)}")
                if statement.fold and len(module.held) == 1:
                    text = expression(BATCH, margin(statement.condition))
                    lines.append(
                        f"folds.append(np.broadcast_to({text}, full).reshape(-1, count).T)"
                    )
    lines.append("q = (")
    lines += [f"    {expression(BATCH, one.value)}," for one in program.outputs]
    lines.append(")")
    return lines + _batch_flags(module)


def _batch_inputs(module: SolverModule) -> list[str]:
    program = module.program
    lines = []
    for entry in program.inputs_of(PoseEntry):
        lines.append(f"{entry.name} = T[:, {entry.row}, {entry.column}].reshape(lane)")
    for seed in program.inputs_of(SeedValue):
        lines.append(f"{seed.name} = q0[:, {seed.joint}].reshape(lane)")
    for one in program.inputs_of(HeldValue):
        lines.append(f"{one.name} = held[:, {module.free_indices.index(one.joint)}].reshape(lane)")
    for angle in program.inputs_of(ArmAngle):
        lines.append(f"{angle.name} = held[:, {len(module.free_indices)}].reshape(lane)")
    lines += [f"{let.name} = {expression(BATCH, let.value)}" for let in program.prelude]
    return [
        *lines,
        "valid: _Flags = np.ones(lane, dtype=bool)",
        "singular: _Flags = np.zeros(lane, dtype=bool)",
    ]


def _batch_flags(module: SolverModule) -> list[str]:
    program = module.program
    rough = "np.ones(1, dtype=bool)"
    if module.tells_rough:
        rough = " | ".join(["singular", *(f"({r} > _ROUGH)" for r in program.residuals)])
    doubt = " | ".join(program.doubts) or "np.zeros(1, dtype=bool)"
    return [f"rough: _Flags = {rough}", f"doubt: _Flags = {doubt}"]
