"""The worked example: all rows of the pose and no others, told apart, the paper's where it has one."""

from __future__ import annotations

import re
from functools import cache
from html import escape
from pathlib import Path

import numpy as np
import pytest

from ikgen.derivation.derive import derive
from ikgen.emit.derivation import Derivation
from ikgen.kinematics.forward import row_values
from ikgen.records.request import Request
from ikgen.report import emit_report
from ikgen.report.roots_picture import hidden_roots
from ikgen.report.worked_example import WorkedExample, solver_of, worked_example

pytestmark = pytest.mark.usefixtures("solved_once")

ROOT = Path(__file__).resolve().parents[2]
ARMS = {
    "puma": "urdf_fixtures/puma560_paper.toml",
    "ur5e": "urdf_fixtures/ur5e.urdf",
    "kuka": "urdf_fixtures/kuka_kr6r900sixx.urdf",
    "olson": "urdf_fixtures/olson13.toml",
    "fr3": "urdf_fixtures/franka_fr3.urdf",
    "eliminated": "tests/robots/tables/Issue4.toml",
}

PAPER = np.array([
    [-287.08771, 130.00008, -191.92745, -6.78054, -66.24462, 4.13687],
    [29.99995, 49.99992, 39.99994, -135.00007, -119.99981, -120.00010],
    [29.99995, 148.48625, -191.92745, 142.01103, 95.78709, -151.06756],
    [-287.08771, 31.51375, 39.99994, 18.00641, 159.53838, 18.33206],
    [-287.08771, 130.00008, -191.92745, 173.21946, 66.24462, -175.86313],
    [29.99995, 148.48625, -191.92745, -37.98897, -95.78709, 28.93244],
    [29.99995, 49.99992, 39.99994, 44.99993, 119.99981, 59.99990],
    [-287.08771, 31.51375, 39.99994, -161.99359, -159.53838, -161.66794],
])  # fmt: skip
"""Zhang and Hannaford 2017, table "Puma 560 Numerical Solutions", degrees."""


@cache
def derivation(name: str) -> Derivation:
    tip = "tool0" if name == "ur5e" else None
    return derive(Request(ROOT / ARMS[name], tip=tip))


@cache
def example(name: str) -> WorkedExample:
    solver = solver_of(derivation(name))
    assert solver is not None
    return worked_example(derivation(name), solver)


def names(name: str) -> tuple[str, ...]:
    return example(name).names


def test_the_papers_puma_has_the_papers_pose_and_rows() -> None:
    found = example("puma")
    np.testing.assert_allclose(np.degrees(found.q), [30, 50, 40, 45, 120, 60])
    np.testing.assert_allclose(found.pose[:3, 3], [-1.68074, 1.33902, -4.83022], atol=1e-5)
    assert len(found.rows) == 8
    for row in PAPER:
        apart = np.remainder(np.degrees(found.rows) - row + 180, 360) - 180
        # the paper's own rows are off by what it rounded its pose to
        assert np.abs(apart).max(axis=1).min() < 3e-3
    html = emit_report(derivation("puma"))["puma560_report.html"]
    for row in found.rows:
        cells = "".join(f"<td>{np.degrees(x):.3f}°</td>" for x in row)
        assert cells in html
    assert len(re.findall(r'<svg[^>]*class="arm"', html)) == 9


@pytest.mark.parametrize("name", ARMS)
def test_rows_are_right_and_told_apart(name: str) -> None:
    found = example(name)
    solver = solver_of(derivation(name))
    assert solver is not None and len(found.rows) > 1
    np.testing.assert_allclose(solver.forward(found.rows), np.broadcast_to(
        found.pose, (len(found.rows), 4, 4)), atol=2e-9)  # fmt: skip
    chord = np.abs(np.exp(1j * found.rows[:, None]) - np.exp(1j * found.rows[None])).max(axis=2)
    assert chord[~np.eye(len(found.rows), dtype=bool)].min() > 1e-4
    lower, upper = solver.constants.lower, solver.constants.upper
    inside = np.all((found.rows > lower - 1e-6) & (found.rows < upper + 1e-6), axis=1)
    assert np.array_equal(inside, found.inside) and found.inside.any()
    assert np.abs(np.exp(1j * found.rows) - np.exp(1j * found.q)).max(axis=1).min() < 1e-6
    assert len(names(name)) == len(found.rows)


@pytest.mark.parametrize("name", ["puma", "ur5e", "kuka"])
def test_postures_have_their_usual_names(name: str) -> None:
    """Two shoulders, two elbows, two wrists; the elbow that is up is the higher one."""
    told = [tuple(words.split(", ")) for words in names(name)]
    assert len(told) == 8 and {len(parts) for parts in told} == {3}
    assert {p[0] for p in told} == {"shoulder right", "shoulder left"}
    assert {p[2] for p in told} == {"wrist flipped", "wrist not flipped"}
    from ikgen.report.skeleton_bones import skeleton

    heights: dict[tuple[str, str], dict[str, float]] = {}
    for parts, q in zip(told, example(name).rows, strict=True):
        height = float(skeleton(derivation(name).reading.dh, q).frames[3][2, 3])
        heights.setdefault((parts[0], parts[2]), {})[parts[1]] = height
    assert all(pair["elbow up"] > pair["elbow down"] for pair in heights.values())


@pytest.mark.parametrize("name", ARMS)
def test_rows_are_called_what_the_module_calls_them(name: str) -> None:
    found, solver = example(name), solver_of(derivation(name))
    assert solver is not None
    free = found.q[list(derivation(name).module.free_indices)]
    solved = solver.module.solve(found.pose, free=free if len(free) else None, limits=False)
    told = dict(zip(solved.branch, solved.q, strict=True))
    if name == "eliminated":  # all rows are on one branch of the closed form
        assert set(told) == set(names(name)) == {"det J > 0", "det J < 0"}
    else:
        assert set(told) == set(names(name)) and len(told) == len(found.rows)
        for row, words in zip(found.rows, names(name), strict=True):
            np.testing.assert_allclose(np.exp(1j * told[words]), np.exp(1j * row), atol=1e-6)
    module = derivation(name).module.name
    html = emit_report(derivation(name))[f"{module}_report.html"]
    for number, words in enumerate(names(name), start=1):
        assert f"{number}: {escape(words)}" in html


def test_sixteen_roots_and_the_real_ones_are_the_solutions() -> None:
    d, found = derivation("eliminated"), example("eliminated")
    assert d.module.plan is not None
    joint, sign, roots = hidden_roots(d.module.plan, found.pose)
    assert len(roots) == 16
    on_circle = np.sort(np.angle(roots[np.abs(np.abs(roots) - 1) < 1e-6]))
    angles = sign * row_values(d.reading.dh, found.rows)[:, joint]
    wrapped = np.sort(np.remainder(angles + np.pi, 2 * np.pi) - np.pi)
    np.testing.assert_allclose(on_circle, wrapped, atol=1e-6)
    off = roots[np.abs(np.abs(roots) - 1) > 1e-6]
    for z in off:
        assert np.abs(off - 1 / np.conj(z)).min() < 1e-5


def test_the_held_joint_leads_and_its_interval_holds_the_example() -> None:
    html = emit_report(derivation("fr3"))["fr3_report.html"]
    assert html.index('id="held"') < html.index('id="example"')
    found = re.search(r"inside the limits from (-?\d+)° to (-?\d+)°", html)
    assert found is not None
    low, high = map(float, found.groups())
    assert low - 2.5 < np.degrees(example("fr3").q[6]) < high + 2.5


def test_the_same_input_gives_the_same_page() -> None:
    assert emit_report(derivation("ur5e")) == emit_report(derivation("ur5e"))
