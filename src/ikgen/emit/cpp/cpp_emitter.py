"""Emitter of the C++ header, and of the small CMake package around it."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from ikgen.emit.blanks import blank_functions, blanks
from ikgen.emit.cpp.cpp_language import CONSTANT, comment, declared, literal, number
from ikgen.emit.cpp.cpp_policy import policy_lines
from ikgen.emit.cpp.cpp_statements import ProgramText
from ikgen.emit.cpp.cpp_twist_chain import twist_lines
from ikgen.emit.cpp.header_bundle import bundle_for
from ikgen.emit.cpp.settled_conditions import ArmFacts
from ikgen.emit.elbow_text import elbow_text
from ikgen.emit.gear_text import gear_text
from ikgen.emit.printer import expression
from ikgen.emit.rendering import render
from ikgen.emit.solver_module import SolverModule
from ikgen.kinematics.column_blocks import column_blocks
from ikgen.program.branch_symmetry import with_shared_branches
from ikgen.program.margins import fold_margins
from ikgen.program.ops import Op
from ikgen.program.policy import SolvePolicy

if TYPE_CHECKING:
    from ikgen.emit.derivation import Derivation

__all__ = ["emit", "emit_derivation", "emit_header"]

_SYSTEM = ("array", "cstddef", "Eigen/Core", "Eigen/Geometry")
"""Headers that the shell itself needs."""

_INCLUDES, _POLICY, _RUNTIME = "\2includes\2", "\2RefineStage\2", "\2runtime\2"
"""Where these go once it is known what the rest of the text needs; no name has such characters."""


_PARALLEL_HEADER, _PARALLEL_CLASS = "elimination/parallel_6r.hpp", "Parallel6r"
"""The elimination about two parallel axes, which calls the general one where it has doubts."""


def _columns(module: SolverModule) -> str:
    """First column of the rotation that a task reads, how many, and how many rows of them."""
    columns = module.unit_columns
    rows = 2 if columns and module.reads.orientation == "yaw" else 3
    return f"{min(columns, default=0)}, {len(columns)}, {rows}"


def emit_derivation(derivation: Derivation) -> dict[str, str]:
    """File name -> text of the C++ output."""
    return emit(derivation.module)


def emit(module: SolverModule) -> dict[str, str]:
    """File name -> text of the C++ output."""
    return {f"{module.name}_ik.hpp": emit_header(module)}


def emit_header(module: SolverModule) -> str:
    """The text of `<name>_ik.hpp`."""
    most, module = module.max_solutions, _in_lanes(module)
    branches = [level.branches for level in module.program.levels[1:]]
    shell = _shell(module, branches, most)
    runtime = bundle_for(shell, _known_facts(module), _headers(module), _SYSTEM)
    lines = policy_lines(module.policy, runtime.body)
    with_policy = shell.replace(_POLICY, "\n  ".join(lines)).replace(_INCLUDES, runtime.includes)
    return with_policy.replace(_RUNTIME, runtime.body)


_FEW_LANES = 8
"""Lanes of a level below which half of them cost as much: they fill one vector either way."""


def _in_lanes(module: SolverModule) -> SolverModule:
    """The module with lanes in powers of two: those that a routine's roots leave over stay empty. What both
    branches of a level share is computed before it."""
    levels = tuple(
        replace(level, branches=1 << (level.branches - 1).bit_length())
        for level in module.program.levels
    )
    program = replace(module.program, levels=levels)
    return replace(module, program=with_shared_branches(program, _FEW_LANES))


def _shell(module: SolverModule, branches: list[int], most: int) -> str:
    """The text around the runtime, and marks where that goes."""
    program, text = module.program, ProgramText(module)
    return render(
        "cpp",
        "header.hpp.jinja",
        m=module,
        most=most,
        **_namespaces(module),
        includes=_INCLUDES,
        runtime=_RUNTIME,
        policy=_POLICY,
        careful=_careful(module),
        way="SingleSolve" if _careful(module) else "LaneSolve",
        entries_read=module.reads.entries,
        columns=_columns(module),
        joints=module.dh.joints,
        lower=[number(j.limits.lower) for j in module.dh.joints],
        upper=[number(j.limits.upper) for j in module.dh.joints],
        far_limits=any(_far_limits(module, j) for j in range(module.dh.dof)),
        text=text,
        values=text.joint_values(),
        rough=_rough(module, module.policy),
        order=_depth_first(branches),
        frames=[[[expression(CONSTANT, x) for x in row] for row in F] for F in program.frames],
        solved=[[[number(x) for x in row] for row in F[:3].tolist()] for F in module.solved_frames],
        held=len(module.held),
        elbow=elbow_text(module, number),
        folds=fold_margins(program),
        guarded=module.guarded,
        closed_form="int P, class Out" if len(module.held) == 1 else "int P",
        rows="Out" if len(module.held) == 1 else "Rows<P>",
        beside=[[number(float(x)) for x in D.T[:, :3].ravel()] for D in module.beside],
        size=_size_text(module),
        blanks=blanks(module),
        **_elimination(module),
        **_refinement(module),
        blank_functions=blank_functions(module),
        free_defaults=[number(x) for x in module.free_defaults],
        number=number,
        declared=declared,
        literal=literal,
        comment=comment,
    )


def _far_limits(module: SolverModule, joint: int) -> bool:
    """Whether a joint's limits leave no room within half a period of 0, about which values are given."""
    limits, half = module.dh.joints[joint].limits, 0.5 * module.period(joint)
    return half > 0.0 and (limits.lower > half or limits.upper < -half)


def _known_facts(module: SolverModule) -> ArmFacts:
    """What is known of the constants of `Arm`."""
    return (
        ("kBesides", bool(module.beside)),
        ("kFree", bool(module.held)),
        ("kNewton", _newton(module)),
        ("kRefined", _careful(module)),
        ("kRounded", module.rounded),
    )


def _namespaces(module: SolverModule) -> dict[str, object]:
    """The solver's namespace: inside the `outer` one where functions there have values of motors."""
    outer, geared = f"{module.name}_ik", gear_text(module, number)
    inner = f"{outer}::joints" if geared else outer
    return {"outer": outer, "namespace": inner, "geared": geared}


def _careful(module: SolverModule) -> bool:
    """Whether every pose's rows are judged one by one."""
    return module.plan is not None


def _newton(module: SolverModule) -> bool:
    """Whether all rows are refined at once."""
    return module.rounded or module.program.coarse


def _refinement(module: SolverModule) -> dict[str, object]:
    """What the templates say of rows that are refined at once: the chain for that, the joints by blocks."""
    twisted = twist_lines(module) if _newton(module) else None
    return {"twisted": twisted, "blocks": _blocks(module)}


def _blocks(module: SolverModule) -> tuple[int, ...]:
    """The joints by blocks of their derivatives, where those of all rows are eliminated so."""
    if not _newton(module) or not module.reads.whole_pose or module.dh.arm_angle:
        return ()
    moving = [j for j in range(module.dh.dof) if j not in module.free_indices]
    return column_blocks(module.dh, moving, module.size)


def _headers(module: SolverModule) -> list[str]:
    """The runtime's headers that the module needs, without those that they include."""
    routines = module.program.routines
    needed = [
        "arrays/lane_angle.hpp",
        "solving/single_solve.hpp" if _careful(module) else "solving/lane_solve.hpp",
    ]
    needed += ["roots/routine_roots.hpp"] * bool(routines)
    needed += [one.cpp_header for one in routines]
    needed += [_PARALLEL_HEADER] * bool(_parallel_kind(module))
    needed += ["arm/tool_joint.hpp"] * (module.plan is not None and module.plan.tool is not None)
    needed += ["newton/lane_refinement.hpp"] * _newton(module)
    if module.dh.arm_angle:
        needed += ["held/lane_elbow.hpp" if _newton(module) else "held/arm_angle_motion.hpp"]
    needed += ["held/displacement.hpp"] * bool(module.beside)
    task = "arm/whole_pose.hpp" if module.reads.whole_pose else "arm/pose_entries.hpp"
    needed += [task, "arguments/pose_solver.hpp", "solving/projection.hpp"]
    needed += ["solving/path_following.hpp", *["held/lone_value.hpp"] * bool(module.held)]
    searches = ("solving/ordered_solving.hpp", "held/held_search.hpp", "held/held_grid_search.hpp")
    motors = ["solving/motor_values.hpp"] * (module.dh.transmission is not None)
    return [*needed, searches[min(len(module.held), 2)], *motors]


def _elimination(module: SolverModule) -> dict[str, object]:
    """What the templates say of an elimination: its routine, class, and the numbers that it gives a row."""
    calls = [level.call for level in module.program.levels if level.call is not None]
    if module.plan is None:
        return {"routine": ""}
    call, kind = calls[0], _parallel_kind(module)
    return {
        "routine": call.routine.name,
        "elimination": _PARALLEL_CLASS if kind else call.routine.cpp_class,
        "parallel_kind": kind,
        "numbers": len(call.names),
        "all_turn": all(module.plan.turning),
    }


def _parallel_kind(module: SolverModule) -> str:
    """The kind of the elimination about two parallel axes that comes before the general one; empty where
    there is none, or where its polynomial would leave most poses to that."""
    plan = module.plan.parallel if module.plan is not None else None
    return f"k{plan.kind.name.title()}" if plan is not None and plan.bounded else ""


def _size_text(module: SolverModule) -> str:
    """The arm's size as a number, or as an expression in constants to be filled in."""
    if not module.dh.symbols:
        return number(module.size)
    lengths = [F[i][3] for F in module.program.frames for i in range(3)]
    texts = [expression(CONSTANT, Op("abs", (x,))) for x in lengths if x != 0.0]
    return f"std::max({{{', '.join(['1.0', *texts])}}})"


def _depth_first(branches: list[int]) -> list[int]:
    """Lane of each row, depth first: branch i of a level adds i times the width before it."""
    lanes, width = [0], 1
    for n in branches:
        lanes = [lane + i * width for lane in lanes for i in range(n)]
        width *= n
    return lanes


def _rough(module: SolverModule, policy: SolvePolicy) -> str:
    """Condition under which a row takes Newton steps."""
    program = module.program
    if module.rounded:
        return "(spread<1>(1.0) > 0.0)"
    return " | ".join(
        [*program.singular, *(f"({r} > {policy.rough_square})" for r in program.residuals)]
    )
