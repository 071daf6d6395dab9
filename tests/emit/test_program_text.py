"""The text of a Program made by hand does what the Program does: in loops, in arrays, and parts of C++."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from tests.support.made_programs import POSES, made_module, made_program, with_limits

from ikgen.emit.cpp.cpp_statements import ProgramText
from ikgen.emit.python.python_statements import batch_lines, scalar_lines
from ikgen.emit.solver_module import SolverModule
from ikgen.program.interpret import run
from ikgen.program.ops import Op
from ikgen.program.policy import SolvePolicy
from ikgen.program.statements import Let
from ikgen.runtime.python.roots.trig_quartic_roots import trig_quartic_branches, trig_quartic_lanes
from ikgen.runtime.python.solving.batch_solving import branch_axis

SEED, HELD = 0.4, 0.2
ROUGH = SolvePolicy().rough_square
NAMES = {
    "np": np, "sqrt": math.sqrt, "sin": math.sin, "cos": math.cos, "atan2": math.atan2,
    "a_1": 0.5, "k1": 0.25, "_ROUGH": ROUGH, "_branch_axis": branch_axis,
    "_trig_quartic_branches": trig_quartic_branches, "_trig_quartic_lanes": trig_quartic_lanes,
    "_Flags": np.ndarray,
}  # fmt: skip


def function(arguments: str, lines: list[str], answer: str) -> Callable:
    """A Python function with these lines as its body."""
    text = "\n    ".join([f"def made({arguments}):", *lines, f"return {answer}"])
    names = dict(NAMES)
    exec(text, names)
    return names["made"]  # type: ignore[return-value]


def expected(x: float, y: float) -> list[tuple[tuple[float, ...], bool]]:
    """Rows of the Program by its interpreter, and whether each is flagged."""
    inputs = {"t03": x, "t13": y, "seed_q1": SEED, "held_q3": HELD}
    rows = run(made_program(), inputs, {"trig_quartic": trig_quartic_branches})
    return [(row.q, row.singular) for row in rows]


def test_the_made_program_has_rows_none_and_continua() -> None:
    counts = [len(expected(x, y)) for x, y in POSES]
    assert 0 in counts and max(counts) > 2
    assert {flag for x, y in POSES for _, flag in expected(x, y)} == {False, True}


@pytest.mark.parametrize("refine", [False, True])
def test_loops_give_the_rows_of_the_program(refine: bool) -> None:
    module = made_module()
    if refine:
        module = replace(module, dh=replace(module.dh, deviation=(0.0, 1e-3)))
    start = ["rows = []", "doubt = False"]
    solve = function("q0, held, t03, t13", [*start, *scalar_lines(module)], "rows, doubt")
    for x, y in POSES:
        rows, doubt = solve([SEED, 0.0, 0.0], [HELD], x, y)
        wanted = expected(x, y)
        assert [q for q, _ in rows] == [q for q, _ in wanted]
        if wanted:
            assert doubt == wanted[0][1]
        offs = [math.cos(q[1]) ** 2 * 1e-19 for q, _ in rows]
        rough = [refine or doubt or off > ROUGH for off in offs]
        assert [flag for _, flag in rows] == rough


def test_loops_of_a_single_joint_still_make_rows() -> None:
    module = made_module()
    program = replace(module.program, outputs=module.program.outputs[:1], residuals=(), singular=())
    lines = scalar_lines(replace(module, program=program))
    solve = function("q0, held, t03, t13", ["rows = []", "doubt = False", *lines], "rows")
    rows = solve([SEED], [HELD], *POSES[0])
    assert rows and all(len(q) == 1 and rough is False for q, rough in rows)


def test_arrays_give_the_rows_of_the_program() -> None:
    module = made_module()
    count = len(POSES)
    T = np.tile(np.eye(4), (count, 1, 1))
    T[:, :2, 3] = POSES
    q0, held = np.tile([SEED, 0.0, 0.0], (count, 1)), np.full((count, 1), HELD)
    solve = function(
        "T, q0, held, lane, full, count, folds",
        batch_lines(module),
        "q, valid, singular, rough",
    )
    folds: list[np.ndarray] = []
    full = (2, 4, count)
    with np.errstate(all="ignore"):
        q, valid, singular, rough = solve(T, q0, held, (1, 1, count), full, count, folds)
    rows = np.stack([np.broadcast_to(x, full) for x in q], axis=-1).reshape(8, count, 3)
    valid, singular, rough = (
        np.broadcast_to(x, full).reshape(8, count) for x in (valid, singular, rough)
    )
    assert len(folds) == 2 and all(fold.shape == (count, 8) for fold in folds)
    for k, (x, y) in enumerate(POSES):
        wanted = expected(x, y)
        found = rows[valid[:, k], k]
        assert len(found) == len(wanted)
        np.testing.assert_allclose(
            found, np.array([w for w, _ in wanted]).reshape(-1, 3), atol=1e-12
        )
        flags = [flag for _, flag in wanted]
        assert singular[valid[:, k], k].tolist() == flags
        offs = np.cos(found[:, 1]) ** 2 * 1e-19 > ROUGH
        assert (
            rough[valid[:, k], k].tolist()
            == np.logical_or(offs, np.array(flags, dtype=bool)).tolist()
        )
        assert folds[0][k] == pytest.approx(x * x + y * y - 0.25)
        assert ((folds[0][k] > 0) & (folds[1][k] > 0))[valid[:, k]].all()


@pytest.mark.parametrize("held", [0, 2])
def test_where_branches_meet_is_told_for_one_held_joint_alone(held: int) -> None:
    module = made_module()
    free = ("q1", "q2")[:held]
    other = replace(module, dh=replace(module.dh, free=free))
    if not held:
        inputs = tuple(one for one in module.program.inputs if one.name != "held_q3")
        other = replace(other, program=replace(module.program, inputs=inputs))
    assert sum("folds.append" in line for line in batch_lines(module)) == 2
    assert not any("folds.append" in line for line in batch_lines(other))
    assert not any("fold<" in line for line in ProgramText(other).lines)


def text_of(module: SolverModule) -> tuple[ProgramText, str]:
    found = ProgramText(module)
    return found, " ".join(" ".join(found.lines).split())


def test_cpp_numbers_guards_and_folds_in_their_order() -> None:
    found, text = text_of(made_module())
    places = [text.index(f"rows.template fold<{k}>(") for k in (0, 1)]
    assert places == sorted(places) and text.count("rows.template fold<") == 2
    reals = [text.index(f"const auto real_{k} = ") for k in (1, 2, 3, 4)]
    assert reals == sorted(reals) and "real_5" not in text and found.real == "real_4"
    for k in (2, 3, 4):
        assert f"const auto real_{k} = real_{k - 1} & " in text


def test_cpp_names_what_a_routine_finds_and_what_branches_decide() -> None:
    found, text = text_of(made_module())
    assert "const auto sigma_1 = signs<2 * P>();" in text
    assert (
        "const auto roots_2 = roots_of<4, 2, 2 * P>(trig_quartic_branches, 0.25, d3, c1, -s1, 0.1);"
        in text
    )
    for k, name in enumerate(("c2", "s2")):
        assert text.count(f"const auto {name} = roots_2.value[{k}];") == 1
    assert "const auto real_3 = real_2 & roots_2.found;" in text
    assert found.flags["meeting"] == ["meeting<Policy, 2 * P>(c1, s1)", "roots_2.found"]
    assert found.flags["hit"] == ["(real_1 & near)"]
    assert [line for line in found.lines if line.startswith("//")] == [
        "// the sides", "// theta_1: made up", "// theta_2: made up"
    ]  # fmt: skip


def test_cpp_leaves_out_what_nothing_reads() -> None:
    module = made_module()
    program = module.program
    last = replace(program.levels[2], body=(Let("idle", "s2"), *program.levels[2].body[2:]))
    outputs = (program.outputs[0], replace(program.outputs[1], value="c2"), program.outputs[2])
    program = replace(program, levels=(*program.levels[:2], last), outputs=outputs)
    _, text = text_of(replace(module, program=program))
    assert "idle" not in text and "const auto s2" not in text and "const auto c2 = " in text


def test_cpp_takes_constants_under_an_arctangent_as_packs() -> None:
    module = made_module()
    program = module.program
    more = [
        Let("t1", Op("atan2", ("k1", "x1"))),
        Let("t2", Op("add", (Op("atan2", ("x1", 0.5)), "t1"))),
    ]
    first = replace(program.levels[0], body=(*program.levels[0].body, *more))
    outputs = (replace(program.outputs[0], value="t2"), *program.outputs[1:])
    program = replace(program, levels=(first, *program.levels[1:]), outputs=outputs)
    _, text = text_of(replace(module, program=program))
    assert "const auto t1 = angle(spread<1>(k1), x1);" in text
    assert "const auto t2 = angle(x1, spread<1>(0.5)) + t1;" in text


def test_cpp_reads_inputs_by_their_places() -> None:
    found = ProgramText(made_module())
    assert found.bindings() == [
        "const auto t03 = pose.t[0][3];",
        "const auto t13 = pose.t[1][3];",
        "const auto seed_s1 = spread<1>(seed.seed_s1);",
        "const double held_q3 = held[0];",
        "const auto d3 = spread<1>(held_q3 + 0.3);",
    ]
    assert [let.name for let in found.seed_lets()] == ["seed_s1"]
    assert found.seed_members() == [("seed_s1", "0.0", "std::sin(q[0])")]
    assert found.constants == [("a_1", "0.5"), ("k1", "a_1 * a_1")]


PI = math.pi
VALUE = "angle(s1, c1)"
PLACED = f"place<Policy>(0, {VALUE}, range, kPeriod[0])"


@pytest.mark.parametrize(
    ("limits", "placed"),
    [
        ((-math.inf, math.inf), False), ((-PI, PI), False), ((-4.0, 4.0), False), ((-PI, 3.0), True),
        ((-3.0, PI), True), ((-math.inf, 3.0), True), ((-3.0, math.inf), True), ((-1.0, 1.0), True),
        ((0.0, 7.0), True), ((-7.0, 0.0), True),
    ],
)  # fmt: skip
def test_only_joints_that_may_be_outside_are_put_inside(
    limits: tuple[float, float], placed: bool
) -> None:
    every = (-math.inf, math.inf)
    module = with_limits(made_module(), limits, every, every)
    assert ProgramText(module).joint_values() == [
        (PLACED if placed else VALUE, placed),
        ("angle(s2, c2)", False),
        ("spread<1>(held_q3)", False),
    ]
    module = with_limits(made_module(), every, every, limits)
    value = "spread<1>(held_q3)"
    clamped = value if limits == every else f"clamp(2, {value}, range)"
    assert ProgramText(module).joint_values()[2] == (clamped, limits != every)
    held = replace(module, dh=replace(module.dh, free=("q0",)))
    held = with_limits(held, limits, every, every)
    program = replace(held.program, inputs=held.program.inputs[:3])
    clamped = VALUE if limits == every else f"clamp(0, {VALUE}, range)"
    first = ProgramText(replace(held, program=program)).joint_values()[0]
    assert first == (clamped, limits != every)


def test_cpp_lines_break_between_words() -> None:
    found = ProgramText(made_module())
    assert max(map(len, found.lines)) <= 110
    for word in ("w" * 150, "some-what_like-this"):
        found.lines.clear()
        found._statement(" ".join([word] * 20))
        assert " ".join(found.lines).split() == [word] * 20 and len(found.lines) > 1
        assert all(line.startswith("    " + word[0]) for line in found.lines[1:])
