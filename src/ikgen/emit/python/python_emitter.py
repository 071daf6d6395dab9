"""Emitter of the Python module: the Program as nested loops (scalar) and as arrays (batch)."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import TYPE_CHECKING, Any

from ikgen.elimination.routine import runtime_policy
from ikgen.emit.blanks import blank_functions, blanks
from ikgen.emit.elbow_text import elbow_text
from ikgen.emit.gear_text import gear_text
from ikgen.emit.printer import expression
from ikgen.emit.python.branch_kinds import branch_kind, elbow_end
from ikgen.emit.python.bundle import bundle
from ikgen.emit.python.python_language import SCALAR, number
from ikgen.emit.python.python_statements import batch_lines, scalar_lines
from ikgen.emit.python.python_text import literal, words
from ikgen.emit.python.reached_definitions import Key
from ikgen.emit.python.settled_branches import SOME, Facts
from ikgen.emit.rendering import render
from ikgen.emit.solver_module import SolverModule
from ikgen.emit.twist_numbers import twist_numbers
from ikgen.program.branch_symmetry import with_shared_branches
from ikgen.runtime.python.arm.solve_policy import Policy

if TYPE_CHECKING:
    from ikgen.emit.derivation import Derivation

__all__ = ["concrete_types", "emit_derivation", "emit_module", "known_facts", "shell_values"]


def emit_derivation(derivation: Derivation) -> dict[str, str]:
    """File name -> text of the Python output."""
    module = derivation.module
    return {f"{module.name}_ik.py": emit_module(module)}


def emit_module(module: SolverModule) -> str:
    """The text of `<name>_ik.py`."""
    shell = render("python", "module.py.jinja", compiled=False, **shell_values(module))
    return bundle(shell, known_facts(module), concrete_types(module))


def shell_values(module: SolverModule) -> dict[str, Any]:
    """What the templates say of an arm."""
    program = with_shared_branches(module.program)
    module = replace(module, program=program)
    return {
        "m": module,
        "joints": module.dh.joints,
        "lower": [number(j.limits.lower) for j in module.dh.joints],
        "upper": [number(j.limits.upper) for j in module.dh.joints],
        "parameters": _parameters(module),
        "blanks": blanks(module),
        "constants": [(c.name, expression(SCALAR, c.value)) for c in program.constants],
        "scalar": scalar_lines(module),
        "batch": batch_lines(module),
        "routines": program.routines,
        "finder": _finder(module),
        "seeds": _seed_rows(module),
        "shape": [level.branches for level in program.levels[1:]],
        "frames": [[[expression(SCALAR, x) for x in row] for row in F] for F in program.frames],
        "solved": [
            [[number(x) for x in row] for row in F[:3].tolist()] for F in module.solved_frames
        ],
        "rows": [(row.driver, row.revolute, row.scale, row.offset.value) for row in module.dh.rows],
        "lanes": twist_numbers(module, number) if module.rounded else None,
        "number": number,
        "literal": literal,
        "words": words,
        "held": len(module.held),
        "held_name": words(_held_name(module)),
        "held_turns": module.dh.arm_angle or _held_turns(module),
        "elbow": elbow_text(module, number),
        "geared": gear_text(module, number),
        "guarded": module.guarded,
        "beside": [[[number(float(x)) for x in row] for row in D] for D in module.beside],
        "orientation": module.reads.orientation,
        "entries": module.reads.entries,
        "size": module.size,
        "branch_kind": branch_kind(module),
        "elbow_end": elbow_end(module),
        "unit_columns": module.unit_columns,
        "policy": module.policy,
        "policy_values": _policy_values(runtime_policy(module.policy)),
    }


def _finder(module: SolverModule) -> dict[str, str] | None:
    """Where the runtime has what finds an elimination's candidates, and what the module calls it."""
    if module.plan is None:
        return None
    find = module.plan.routine.find
    alias = f"_{find.__name__}" if isinstance(find, type) else "_candidates"
    return {"module": find.__module__.split(".")[-1], "name": find.__name__, "alias": alias}


def known_facts(module: SolverModule) -> Facts:
    """What is known of the runtime's `Arm` that the templates make."""
    branches = None if module.plan is not None else SOME
    known = [
        ("around", branches),
        ("beside", SOME if module.beside else ()),
        ("branch_kind", branch_kind(module)),
        ("branches", branches),
        ("free", SOME if module.free_indices else ()),
        ("free_joints", SOME if module.held else ()),
        ("policy.beside_anywhere", runtime_policy(module.policy).beside_anywhere),
        ("rounded", module.rounded),
        (
            "square",
            module.reads.whole_pose
            and module.dh.dof - len(module.free_indices) == 6
            and not module.dh.arm_angle,
        ),
        ("together", SOME if module.rounded else None),
    ]
    return tuple(known if module.dh.arm_angle else [*known, ("angle", None)])


def concrete_types(module: SolverModule) -> dict[Key, Key]:
    """The classes that the module has of what the runtime knows by protocols."""
    whole = module.reads.whole_pose
    task = ("arm.whole_pose", "PoseTask") if whole else ("arm.pose_entries", "EntriesTask")
    out = {("arm.task_interface", "Task"): task} if whole or module.plan is None else {}
    if module.dh.arm_angle:
        out["arm.solved_arm", "HeldAngle"] = ("held.arm_angle", "ArmAngle")
    return out


def _held_name(module: SolverModule) -> str:
    """What is held first, as the text of the module calls it; empty where nothing is."""
    if module.dh.arm_angle and not module.free_indices:
        return "the arm angle"
    return module.held[0] if module.held else ""


def _held_turns(module: SolverModule) -> bool:
    return bool(module.free_indices) and module.dh.lead_row(module.free_indices[0]).revolute


def _policy_values(policy: Policy) -> list[tuple[str, str]]:
    """The fields of the runtime's `Policy` as text."""
    out = []
    for field in fields(policy):
        value = getattr(policy, field.name)
        if field.name == "refinement":
            stages = (f"({steps}, {number(a)}, {number(b)})" for steps, a, b in value)
            out.append((field.name, f"({', '.join(stages)})"))
        else:
            out.append((field.name, repr(value) if isinstance(value, int) else number(value)))
    return out


def _parameters(module: SolverModule) -> list[tuple[str, str]]:
    """Name and text of the arm's constants but those to be filled in."""
    functions = blank_functions(module)
    given = [p for p in module.program.parameters if p.name not in module.dh.symbols]
    plain = [(p.name, number(p.value)) for p in given if p.function not in functions]
    return [*((f.name, f"{f.function}({f.angle})") for f in functions), *plain]


def _seed_rows(module: SolverModule) -> list[tuple[int, bool, float, float]]:
    """Per joint: index, revolute, scale and offset of its leading row."""
    out = []
    for j in range(module.dh.dof):
        row = module.dh.lead_row(j)
        out.append((j, row.revolute, row.scale, row.offset.value))
    return out
