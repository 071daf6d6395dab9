"""The files of the crate."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import TYPE_CHECKING

from ikgen.emit.rendering import folder_environment
from ikgen.emit.solver_module import SolverModule
from ikgen.program.interpret import evaluate
from ikgen.program.statements import Program
from ikgen_rust.body import body_lines
from ikgen_rust.language import number, text_literal

if TYPE_CHECKING:
    from ikgen.emit.derivation import Derivation

__all__ = ["CRATE", "emit_derivation"]

CRATE = Path(__file__).parent / "crate"
_SAME_FOR_ALL = ("lib.rs", "chain.rs", "newton.rs", "rows.rs")


def emit_derivation(derivation: Derivation) -> dict[str, str]:
    """Relative path -> text of `<name>_ik_rs/`."""
    module = derivation.module
    folder = f"{module.name}_ik_rs"
    body = body_lines(module)
    values = {
        "m": module,
        "body": body,
        "constants": _constants(module.program, body),
        "entries": _weighted_entries(module),
        "lead_rows": [module.dh.lead_row(j) for j in range(module.dh.dof)],
        "number": number,
        "text": text_literal,
    }
    templates = folder_environment(CRATE)
    files = {
        f"{folder}/Cargo.toml": templates.get_template("Cargo.toml.jinja").render(values),
        f"{folder}/src/arm.rs": templates.get_template("arm.rs.jinja").render(values),
    }
    return files | {f"{folder}/src/{name}": (CRATE / name).read_text() for name in _SAME_FOR_ALL}


def _constants(program: Program, body: list[str]) -> list[tuple[str, str]]:
    """Name and value of the constants that the body reads, as numbers: Rust's sqrt is not const."""
    values = {one.name: one.value for one in program.parameters}
    for let in program.constants:
        values[let.name] = evaluate(let.value, values)
    read = set(re.findall(r"\w+", "\n".join(body)))
    return [(name, number(value)) for name, value in values.items() if name in read]


def _weighted_entries(module: SolverModule) -> list[tuple[int, int, str]]:
    """Row, column and weight of each entry of the pose that the task reads.

    Positions count over the arm's size; the nine entries of a whole pose's rotation together count
    as the angle does.
    """
    rotation = math.sqrt(0.5) if module.reads.whole_pose else 1.0
    return [
        (r, c, number(1.0 / module.size if c == 3 else rotation)) for r, c in module.reads.entries
    ]
