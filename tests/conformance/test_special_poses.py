"""Tables whose solvers lost solutions where joints lie at multiples of 90 degrees and slides at 0."""

from __future__ import annotations

from math import pi
from pathlib import Path

import numpy as np
import pytest
from tests.support.dh_files import dh_file
from tests.support.sampled import in_languages
from tests.support.solving import NO_COMPILER, import_text

from ikgen.derivation.derive import derive
from ikgen.emit.cpp.cpp_emitter import emit_header
from ikgen.emit.python.python_emitter import emit_module
from ikgen.records.request import Request
from ikgen.tasks import find_task
from ikgen.verify.runners.cpp_header import CppHeader
from ikgen.verify.runners.python_module import PythonModule
from ikgen.verify.runners.runner import Runner
from ikgen.verify.task_space import task_space

pytestmark = pytest.mark.usefixtures("solved_once")

# kind, alpha (quarters), a, d of each row; joint values
SLIDE = (
    [
        ("revolute", 0, 0.0, 0.44),
        ("revolute", -1, 0.0, 0.0),
        ("prismatic", 0, 0.0, 0.0),
        ("revolute", -1, 0.74, 0.0),
        ("revolute", 1, 0.0, 0.35),
    ],
    [-pi, -pi / 2, 0.0, 0.1546173992229667, pi],
)
FOLDS = (
    [
        ("revolute", 0, 0.0, 0.851283243473224),
        ("revolute", -1, 0.2627114187209788, 0.0),
        ("revolute", 0, 0.7344616072714591, 0.0),
        ("revolute", 1, 0.0, 0.0),
        ("revolute", 0, 0.5723887521825102, 0.0),
    ],
    [0.0, 1.5094153249861169, pi / 2, -pi, pi],
)

QUARTICS = (
    [
        ("revolute", 0, 0.0, 0.0),
        ("revolute", 0, 0.3084523523618435, 0.615170442483001),
        ("revolute", -1, 0.4145408166397275, 0.0),
        ("revolute", -1, 0.3181643724869212, 0.0),
        ("revolute", -1, 0.5746268653713172, 0.0),
    ],
    [pi, -pi, pi / 2, -0.43461341559486044, 0.13840886864980817],
)
BEHIND_A_QUARTIC = (
    [
        ("prismatic", 0, 0.0, 0.0),
        ("revolute", 0, 0.0, 0.0),
        ("revolute", -1, 0.0, 0.0),
        ("revolute", 1, 0.44708589017540884, 0.0),
        ("revolute", -1, 0.905045738190152, 0.0),
    ],
    [-0.7296057862685923, 0.4262236538833992, -pi / 2, 2.081041988664359, -pi / 2],
)
UPRIGHT = (
    [
        ("revolute", 0, 0.0, 0.0),
        ("prismatic", 1, 0.2133, 0.0),
        ("revolute", 1, 0.6879, 0.0),
        ("revolute", -1, 0.4294, 0.0),
        ("prismatic", 1, 0.7624, 0.0),
    ],
    [0.3, 0.4, 0.5, pi, 0.6],
)
"""The tool upright: every divisor of the closed form vanishes, and three joints move it in a plane."""
MEETING_AXES = (
    [
        ("revolute", 0, 0.0, 0.0),
        ("revolute", 1, 0.375, 0.0),
        ("revolute", 1, 0.0, 0.0),
        ("revolute", 1, 0.0, 0.0),
        ("revolute", 1, 0.325, 0.0),
    ],
    [[0.19, 0.0, pi / 2, 0.56, pi / 2], [-2.29, 0.43, -pi / 2, 2.08, pi / 2]],
    [0, 4],
)
PARALLEL_SLIDES = (
    [
        ("revolute", 0, 0.0, 0.0),
        ("revolute", 1, 0.458, 0.567),
        ("revolute", 1, 0.731, 0.696),
        ("prismatic", 0, 0.0, 0.0),
        ("revolute", -1, 0.0, 0.787),
        ("prismatic", -1, 0.0, 0.0),
    ],
    [[-pi / 2, 0.3, 0.0, 0.2, -0.3, 0.73], [0.75, 1.2, pi, 0.3, -1.3, 0.2]],
    [0, 2],
)
MANY_ROWS = (
    [
        ("revolute", 0, 0.0, 0.0),
        ("revolute", -1, 0.24390447985850683, 0.0),
        ("prismatic", 0, 0.0, 0.0),
        ("revolute", 1, 0.7899444512298317, 0.0),
        ("revolute", 0, 0.31173753457682196, 0.29788312819971063),
    ],
    [[0.0] * 5, [-2.365993203, 0.0, -0.067875403, -1.406331282, 0.734319555]],
    [1],
)
NO_ROOTS = (
    [
        ("revolute", 0, 0.0, 0.49624293391800267),
        ("revolute", -1, 0.0, 0.0),
        ("prismatic", 1, 0.0, 0.0),
        ("prismatic", 1, 0.0, 0.0),
        ("revolute", 1, 0.8897371723548606, 0.0),
    ],
    [[-2.93, -pi / 2, 0.306, 0.0, -pi / 2], [pi, -pi / 2, 0.0775, 0.0, pi / 2]],
    [1, 4],
)
"""Tables; configurations of which the forms leave two unknowns and the pose leaves one, beside regular
solutions, or where an elimination finds more rows than there is room for, or no roots, as all angles are
some; joints whose values stay the same along that continuum."""
MEETING_ROOTS = (
    [
        ("revolute", 0, 0.0, 0.0),
        ("revolute", -1, 0.0, 0.0),
        ("revolute", 0, 0.24947209278150773, 0.0),
        ("revolute", -1, 0.0, 0.0),
        ("revolute", 1, 0.4452450889913748, 0.0),
    ],
    [-pi / 2, -pi, -pi, -pi / 2, -pi / 2],
)
"""On a continuum of the third joint, where an elimination's roots meet."""
FOUR_MEET = (
    [
        ("prismatic", 0, 0.0, 0.0),
        ("revolute", 1, 0.589360883235421, 0.726109999271997),
        ("revolute", -1, 0.5224675042290778, 0.0),
        ("revolute", 0, 0.2716203148375721, 0.0),
        ("revolute", -1, 0.8206784047204927, 0.0),
    ],
    [0.0, pi, -1.6045899484602453, pi, 0.0],
)
"""Four solutions meet where the elimination has no rank; beside the pose they are soon far apart."""
STALLED = (
    [
        ("revolute", 0, 0.0, 0.5784682775154428),
        ("revolute", -1, 0.7146873169622483, 0.0),
        ("revolute", 1, 0.6112489915347157, 0.0),
        ("prismatic", 1, 0.8077914741532342, 0.0),
        ("revolute", 0, 0.0, 0.4794171345621271),
        ("revolute", 1, 0.0, 0.0),
    ],
    [3.1415926383, 3.1415926359, 5.4373704223e-09, -1.1467717944e-08, -pi, -2.8306464191],
)
CROWDED = (
    [
        ("revolute", 0, 0.0, 0.0),
        ("revolute", -1, 0.7288073008375118, 0.0),
        ("prismatic", -1, 0.0, 0.0),
        ("revolute", 0, 0.7013271239925323, 0.0),
        ("revolute", 1, 0.0, 0.81681210731014),
    ],
    [-1.5707963264, 3.1415926530, 6.9473251703e-10, -1.6296461676e-09, -1.5707963258],
)
BESIDE = {"stalled": STALLED, "crowded": CROWDED}
"""Solutions beside a continuum: damped steps stall along it, or end at more places than are kept."""
CONTINUA = {
    "turns": MEETING_AXES,
    "slides": PARALLEL_SLIDES,
    "many rows": MANY_ROWS,
    "no roots": NO_ROOTS,
}
SPECIAL = {
    "slide at 0": SLIDE,
    "fold behind a fold": FOLDS,
    "quartic behind a quartic": QUARTICS,
    "fold behind a quartic": BEHIND_A_QUARTIC,
}


def table(rows: list[tuple[str, int, float, float]], folder: Path) -> Path:
    whole = [(kind, f"{quarters}*pi/2", a, d, 0) for kind, quarters, a, d in rows]
    return dh_file(folder / "special.toml", whole)


def solvers(
    rows: list[tuple[str, int, float, float]], folder: Path, language: str
) -> tuple[Runner, Runner]:
    """The table's solver in Python, and in a language."""
    module = derive(Request(table(rows, folder))).module
    path, header = folder / "special_ik.py", folder / "special_ik.hpp"
    path.write_text(emit_module(module))
    python = PythonModule(path)
    if language == "python":
        return python, python
    header.write_text(emit_header(module))
    return python, CppHeader(header, python.constants)


@pytest.mark.parametrize(("rows", "q"), SPECIAL.values(), ids=SPECIAL)
def test_the_generating_configuration_is_found(
    rows: list[tuple[str, int, float, float]], q: list[float], tmp_path: Path
) -> None:
    module = derive(Request(table(rows, tmp_path), task="pose")).module
    arm = import_text(emit_module(module), tmp_path)
    found = arm.solve(arm.forward(q), limits=False)
    apart = np.abs((found.q - q + pi) % (2 * pi) - pi).max(axis=1, initial=0.0)
    assert len(found) and apart.min() < 1e-5
    assert np.abs(arm.forward(found.q) - arm.forward(q)).max() < 1e-9


def test_solutions_that_meet_are_found_without_rank(tmp_path: Path) -> None:
    rows, q = FOUR_MEET
    arm = import_text(emit_module(derive(Request(table(rows, tmp_path))).module), tmp_path)
    found = arm.solve(arm.forward(q))
    apart = np.abs((found.q - q + pi) % (2 * pi) - pi).max(axis=1)
    assert 3 <= len(found) <= 6 and found.singular[apart.argmin()] and apart.min() < 1e-3
    assert np.abs(arm.forward(found.q)[:, :3, 3] - arm.forward(q)[:3, 3]).max() < 1e-9


def test_roots_that_meet_leave_no_pose_without_rows(tmp_path: Path) -> None:
    rows, q = MEETING_ROOTS
    arm = import_text(emit_module(derive(Request(table(rows, tmp_path))).module), tmp_path)
    found = arm.solve(arm.forward(q))
    apart = np.abs((found.q - q + pi) % (2 * pi) - pi)[:, [0, 1, 3, 4]].max(axis=1, initial=0.0)
    assert len(found) and found.singular[apart.argmin()] and apart.min() < 1e-6


@pytest.mark.parametrize(("kind", "language"), in_languages(BESIDE, []))
def test_solutions_beside_a_continuum_are_found(kind: str, language: str, tmp_path: Path) -> None:
    rows, q = BESIDE[kind]
    python, runner = solvers(rows, tmp_path, language)
    space = task_space(find_task(python.constants.task))
    pose = python.forward(np.array([q]))
    answers = runner.solve_many(pose)
    found = answers.q[0, : answers.count[0]]
    off = np.abs((found - q + pi) % (2 * pi) - pi).max(axis=1, initial=0.0)
    assert len(found) and off.min() < 1e-5
    aims = np.broadcast_to(pose, (len(found), 4, 4))
    assert np.abs(space.residual(runner.forward(found), aims)).max() < 5e-9  # m, of 3 m


@pytest.mark.parametrize(("kind", "language"), in_languages(CONTINUA, []))
def test_a_continuum_has_a_row(kind: str, language: str, tmp_path: Path) -> None:
    """From whatever seed; with that of one of its configurations, this one."""
    rows, configurations, fixed = CONTINUA[kind]
    python, runner = solvers(rows, tmp_path, language)
    space = task_space(find_task(python.constants.task))
    q = np.array(configurations)
    poses = python.forward(q)
    seeds = np.random.default_rng(5).uniform(-3.0, 3.0, q.shape)
    for seed in (None, seeds, q):
        answers = runner.solve_many(poses, seeds=seed)
        for k, n in enumerate(answers.count.tolist()):
            found = answers.q[k, :n]
            aims = np.broadcast_to(poses[k], (n, 4, 4))
            assert np.abs(space.residual(runner.forward(found), aims)).max() < 1e-9
            off = np.abs((found - q[k] + pi) % (2 * pi) - pi)
            of_it = (off[:, fixed].max(axis=1) < 1e-6) & answers.singular[k, :n]
            assert of_it.any()
            assert seed is not q or off.max(axis=1).min() < 1e-6


@pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER)
def test_where_every_divisor_vanishes_the_pose_is_answered(tmp_path: Path) -> None:
    """From whatever seed, and inside the limits where it can be."""
    rows, configuration = UPRIGHT
    python, cpp = solvers(rows, tmp_path, "cpp")
    assert python.constants.task == "position-direction"
    rng = np.random.default_rng(5)
    q = rng.uniform(-1.5, 1.5, (30, 5))
    q[:, 3] = np.where(np.arange(30) % 2, pi, 0.0)
    q[0] = configuration
    poses = python.forward(q)
    for runner in (python, cpp):
        for seed in (None, rng.uniform(-3.0, 3.0, q.shape)):
            answers = runner.solve_many(poses, seeds=seed)
            assert set(answers.status) == {"OK"} and (answers.count > 0).all()
            back = runner.forward(answers.q[:, 0])
            assert np.abs(back[:, :3, 2:] - poses[:, :3, 2:]).max() < 1e-9
            assert answers.singular[:, 0].all()
