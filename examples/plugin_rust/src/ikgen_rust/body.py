"""The Program as nested loops in Rust: one loop a level, guards as `continue`."""

from __future__ import annotations

from ikgen.emit.printer import expression
from ikgen.emit.solver_module import SolverModule
from ikgen.errors import UsageError
from ikgen.program.inputs import HeldValue, PoseEntry, SeedValue
from ikgen.program.ops import Operand
from ikgen.program.statements import Comment, Let, Statement
from ikgen_rust.language import RUST_LANGUAGE

__all__ = ["body_lines"]


def body_lines(module: SolverModule) -> list[str]:
    """Lines of `branches`, without the indentation of its body.

    Raises `UsageError` for a Program that calls a bigger routine, of which this package has none.
    """
    program = module.program
    lines = _inputs(module)
    for index, level in enumerate(program.levels):
        if level.call is not None:
            raise UsageError(
                f"the Rust emitter has no routine '{level.call.routine.name}', which this arm needs",
                hint="emit python or cpp",
            )
        if index:
            lines.append("    " * (index - 1) + f"for {level.sigma} in [1.0, -1.0] {{")
        pad = "    " * index
        leave = "continue" if index else "return hit"
        for statement in level.body:
            lines += [pad + line for line in _statement(module, statement, leave)]
    depth = len(program.levels) - 1
    lines += ["    " * depth + line for line in _row(module)]
    lines += ["    " * index + "}" for index in reversed(range(depth))]
    return lines


def _inputs(module: SolverModule) -> list[str]:
    """The inputs by name: entries of the pose, values of the seed and of held joints."""
    program = module.program
    lines = [
        f"let {one.name} = t[{one.row}][{one.column}];" for one in program.inputs_of(PoseEntry)
    ]
    lines += [f"let {one.name} = q0[{one.joint}];" for one in program.inputs_of(SeedValue)]
    for one in program.inputs_of(HeldValue):
        lines.append(f"let {one.name} = held[{module.free_indices.index(one.joint)}];")
    return lines + [f"let {let.name} = {_text(let.value)};" for let in program.prelude]


def _text(operand: Operand) -> str:
    return expression(RUST_LANGUAGE, operand)


def _statement(module: SolverModule, statement: Statement, leave: str) -> list[str]:
    if isinstance(statement, Comment):
        return [f"// {statement.text}"]
    if isinstance(statement, Let):
        line = f"let {statement.name} = {_text(statement.value)};"
        hit = f"hit |= {statement.name};"
        return [line, hit] if statement.name in module.program.singular else [line]
    return [f"if !({_text(statement.condition)}) {{", f"    {leave};", "}"]


def _row(module: SolverModule) -> list[str]:
    """The innermost statements: joint values, and what is known of the row."""
    program = module.program
    singular = " || ".join(program.singular) or "false"
    rough = " || ".join([*program.singular, *(f"{r} > ROUGH_SQUARE" for r in program.residuals)])
    if module.rounded:
        rough = "true"
    row = ", ".join(_text(output.value) for output in program.outputs)
    flags = f"singular: {singular}, rough: {rough or 'false'}"
    return [f"rows.push(Candidate {{ q: [{row}], {flags} }});"]
