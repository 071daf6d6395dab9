"""The C++ runtime by itself: every header compiles alone, and solves an arm written by hand."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.routines import compiled_header, feed
from tests.support.runtime_files import HEADERS, chains, included

from ikgen.emit.cpp.cpp_definitions import definitions, words
from ikgen.emit.cpp.cpp_tokens import masked
from ikgen.emit.cpp.header_bundle import RUNTIME, bundle

Array = NDArray[np.float64]

SOLVE = r"""
#include <cstdio>
#include <vector>
#include "elbow.hpp"
template <class Way>
void answer(const std::vector<Eigen::Isometry3d>& poses, const elbow::Arm::Options& options, bool batch) {
  std::vector<elbow::Solutions> out(poses.size());
  const elbow::Given given(options);
  if (batch) {
    Way::solve(poses.data(), static_cast<std::ptrdiff_t>(poses.size()), given, out.data());
  } else {
    for (std::size_t i = 0; i < poses.size(); ++i) Way::solve(poses[i], given, out[i]);
  }
  for (const auto& one : out) {
    std::printf("%d %d", static_cast<int>(one.status), one.count);
    for (std::size_t k = 0; k < static_cast<std::size_t>(one.count); ++k)
      std::printf(" %.17g %.17g %d", one.q[k][0], one.q[k][1], static_cast<int>(one.singular[k]));
    std::printf("\n");
  }
}
int main() {
  int careful = 0, batch = 0, limits = 0, seeded = 0;
  elbow::Arm::Joints seed;
  if (std::scanf("%d %d %d %d", &careful, &batch, &limits, &seeded) != 4) return 1;
  if (std::scanf("%lf %lf", &seed[0], &seed[1]) != 2) return 1;
  elbow::Arm::Options options;
  options.limits = limits != 0;
  if (seeded != 0) options.seed = &seed;
  std::vector<Eigen::Isometry3d> poses;
  for (double x = 0.0, y = 0.0; std::scanf("%lf %lf", &x, &y) == 2;) {
    poses.push_back(Eigen::Isometry3d::Identity());
    poses.back().translation() << x, y, 0.0;
  }
  if (careful != 0) {
    answer<elbow::Careful>(poses, options, batch != 0);
  } else {
    answer<elbow::Quick>(poses, options, batch != 0);
  }
}
"""
OK, UNREACHABLE, LIMITS, INVALID = range(4)


def eigens(header: str) -> list[str]:
    """Headers of Eigen that one of the runtime includes."""
    return re.findall(r"<(Eigen/\w+)>", bundle([header]).includes)


EIGEN = [header for header in HEADERS if eigens(header)]
CHAINS = [*chains(EIGEN), *chains(set(HEADERS) - set(EIGEN))]


def test_every_header_is_compiled_behind_what_it_includes_alone() -> None:
    assert sorted(header for chain in CHAINS for header in chain) == HEADERS
    for chain in CHAINS:
        for i, header in enumerate(chain):
            seen = {other for one in chain[:i] for other in (one, *included(one))}
            assert seen <= included(header)


@pytest.mark.parametrize("chain", CHAINS, ids=lambda chain: chain[-1])
def test_headers_compile_alone(chain: list[str], tmp_path: Path) -> None:
    # Eigen may be precompiled where a header includes just that: with -fsyntax-only it is not
    eigen = eigens(chain[0])
    assert all(eigens(header) == eigen for header in chain) and eigen in ([], ["Eigen/Geometry"])
    only = "-c" if eigen else "-fsyntax-only"
    lines = [f'#include "{header}"\n' for header in chain]
    compiled_header("".join([*lines, *lines]), tmp_path, only)


def test_no_name_is_a_macro_of_windows() -> None:
    """What <windows.h> defines as macros, in lower case, is the name of nothing."""
    templates = Path(__file__).parents[2] / "templates" / "cpp"
    for file in (*RUNTIME.rglob("*.hpp"), *templates.rglob("*.jinja")):
        code = re.sub(r'//.*|"[^"\n]*"|\{\{.*?\}\}|\{%.*?%\}', "", file.read_text(encoding="utf-8"))
        found = re.findall(r"\b(?:far|hyper|interface|near|pascal|small)\b", code)
        assert not found, f"{file}: {found}"


def defined(header: str) -> set[str]:
    """Names that a header defines, with those of members and of an inner namespace."""
    text = (RUNTIME / header).read_text(encoding="utf-8")
    _, _, inside = text.partition("\nnamespace ikgen_runtime {\n")
    body, _, _ = inside.rpartition("}  // namespace ikgen_runtime")
    return {
        name for one in definitions(body) for part in (one, *one.members) for name in part.names
    }


@pytest.mark.parametrize("header", HEADERS)
def test_a_header_uses_a_name_of_each_that_it_includes(header: str) -> None:
    text = (RUNTIME / header).read_text(encoding="utf-8")
    used = words(masked(text))
    for other in re.findall(r'#include "(.+)"', text):
        assert defined(other) & used, f"nothing of {other}"


@pytest.mark.parametrize("header", HEADERS)
def test_a_header_says_what_it_is(header: str) -> None:
    text = (RUNTIME / header).read_text()
    assert text.count("#pragma once\n") == text.count("\nnamespace ikgen_runtime {\n") == 1
    assert text.endswith("\n}  // namespace ikgen_runtime\n") and len(text.splitlines()) <= 300
    assert not re.search(r"\bPolicy::k\w+ = ", text)


@pytest.fixture(scope="module", params=["", "-march=native"])
def program(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    flags = [request.param] if request.param else []
    return compiled_header(SOLVE, tmp_path_factory.mktemp("elbow"), *flags)


def solve(
    program: Path,
    points: Array,
    *,
    careful: bool = False,
    batch: bool = False,
    limits: bool = False,
    seed: tuple[float, float] | None = None,
) -> list[tuple[int, Array, list[bool]]]:
    """Status, rows (k, 2) and flags of each point (N, 2)."""
    head = [float(careful), float(batch), float(limits), float(seed is not None), *(seed or (0, 0))]
    out = []
    for line in feed(program, [*head, *points.ravel().tolist()]):
        rows = np.array(line[2:]).reshape(-1, 3)
        out.append((int(line[0]), rows[:, :2], [flag != 0.0 for flag in rows[:, 2]]))
        assert len(rows) == line[1]
    assert len(out) == len(points)
    return out


def forward(q: Array) -> Array:
    """The tips (..., 2) of configurations (..., 2)."""
    a, b = q[..., 0], q[..., 0] + q[..., 1]
    return np.stack([np.cos(a) + np.cos(b), np.sin(a) + np.sin(b)], axis=-1)


CONFIGURATIONS = np.random.default_rng(3).uniform((-2.9, -2.4), (2.9, 2.4), (200, 2))


@pytest.mark.parametrize("careful", [False, True])
@pytest.mark.parametrize("batch", [False, True])
def test_both_rows_close_and_one_is_the_generating_one(
    program: Path, careful: bool, batch: bool
) -> None:
    found = solve(program, forward(CONFIGURATIONS), careful=careful, batch=batch)
    for q, (status, rows, flags) in zip(CONFIGURATIONS, found, strict=True):
        assert status == OK and len(rows) == 2 and not any(flags)
        assert np.abs(forward(rows) - forward(q)).max() < 1e-12
        assert np.abs(rows - q).max(axis=1).min() < 1e-9


def test_rows_lie_on_the_turn_inside_the_limits(program: Path) -> None:
    q = np.array([[0.4, 2.9], [0.4, -2.0], [-2.95, 0.3]])
    for careful in (False, True):
        found = solve(program, forward(q), limits=True, careful=careful)
        assert [status for status, _, _ in found] == [OK] * 3
        for rows in (rows for _, rows, _ in found):
            assert ((rows >= (-3.0, -2.5)) & (rows <= (3.0, 7.0))).all()
        assert 2.0 * math.pi - 2.9 == pytest.approx(found[0][1][:, 1].max())


def test_the_nearest_row_to_the_seed_comes_first(program: Path) -> None:
    for seed in ((0.4, 1.0), (0.4 + 1.0, -1.0), (0.4 + 2.0 * math.pi, 1.0)):
        ((_, rows, _),) = solve(program, forward(np.array([[0.4, 1.0]])), seed=seed)
        distance = np.linalg.norm(rows - seed, axis=1)
        assert len(rows) == 2 and distance[0] == pytest.approx(0.0, abs=1e-9) and distance[1] > 1.0


def test_what_cannot_be_reached_or_is_no_pose(program: Path) -> None:
    points = np.array([[2.1, 0.0], [math.nan, 0.0], [math.inf, 0.0], [-2.0, 0.0]])
    for batch in (False, True):
        statuses = [one[0] for one in solve(program, points, batch=batch)]
        assert statuses == [UNREACHABLE, INVALID, INVALID, OK]
    assert solve(program, forward(np.array([[3.07, 2.0]])), limits=True)[0][0] == OK
    assert solve(program, forward(np.array([[3.1, 0.05]])), limits=True)[0][0] == LIMITS


def test_a_stretched_arm_has_one_singular_row(program: Path) -> None:
    ((status, rows, flags),) = solve(program, np.array([[2.0, 0.0]]))
    assert status == OK and len(rows) == 1 and flags == [True] and np.abs(rows).max() < 1e-6


def test_a_folded_arm_takes_the_first_angle_from_the_seed(program: Path) -> None:
    ((status, rows, flags),) = solve(program, np.array([[0.0, 0.0]]), seed=(0.7, 3.0))
    assert status == OK and all(flags)
    assert np.abs(rows[:, 1] - math.pi).max() < 1e-9 and np.abs(rows[:, 0] - 0.7).min() < 1e-9
