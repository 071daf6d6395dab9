"""A thousandth of the soak: poses through compiled headers, and failures that it must notice."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from benchmarks.command_line import REPOSITORY, Emitted, emit
from benchmarks.module_soak import soak_module
from benchmarks.soak import ABOVE, found_source, main, parsed, put_through, soak, soak_program
from benchmarks.soak_counts import Soak, added, table
from tests.support.sampled import sampled
from tests.support.solving import NO_COMPILER

from ikgen.verify import completeness

FIXTURES = REPOSITORY / "urdf_fixtures"
TABLES = REPOSITORY / "tests" / "robots" / "tables"
EXACT = FIXTURES / "kuka_kr6r900sixx.urdf"
POSES, NEAR = 10_000, 1_000
QUICK = ("-O1",)
"""Compiling takes most of the time."""
needs_compiler = pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER or "")
BROKEN = """#pragma once
#include <cstdlib>
#include <string>
#include "arm_ik.hpp"
namespace broken_ik {
using namespace arm_ik;
inline Solutions solve(const Eigen::Isometry3d& pose, const Options& options = {}) {
  static const char* const asked = std::getenv("BROKEN");
  static const std::string how = asked == nullptr ? "" : asked;
  Solutions found = arm_ik::solve(pose, options);
  if (found.count > 1) {
    if (how == "a row dropped") --found.count;
    if (how == "no row") found.count = 0;
    if (how == "a row moved") found.q[0][1] += 1e-6;
  }
  return found;
}
}
"""


@pytest.fixture(scope="module")
def exact(tmp_path_factory: pytest.TempPathFactory) -> Emitted:
    """The header of an arm with exact geometry."""
    return emit(found_source(str(EXACT), ()), tmp_path_factory.mktemp("soak"))


OFTEN = ("elimination",)
KINDS: dict[str, tuple[Path, tuple[str, ...]]] = {
    "three parallel axes": (FIXTURES / "ur5e.urdf", ()),
    "spherical wrist, rounded": (FIXTURES / "doosan_m1013.urdf", ()),
    "smaller task": (FIXTURES / "scara_standard.toml", ()),
    "held joint": (FIXTURES / "franka_fr3.urdf", ("--free", "fr3_joint7")),
    "elimination": (TABLES / "Issue4.toml", ()),
}


@needs_compiler
@pytest.mark.parametrize("kind", sampled(KINDS, OFTEN))
def test_regular_poses_are_answered_rightly(kind: str, tmp_path: Path) -> None:
    robot, options = KINDS[kind]
    made = emit(found_source(str(robot), options), tmp_path)
    found = soak(made, POSES, NEAR, flags=QUICK)
    assert found.rows > POSES / 2
    assert found.failures(ABOVE) == 0, "\n".join(table(found))


@pytest.fixture(scope="module")
def broken(exact: Emitted, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """The program of a header that is wrong as the variable BROKEN says, and right without it."""
    folder = tmp_path_factory.mktemp("broken")
    assert exact.header is not None
    (folder / "arm_ik.hpp").write_text(exact.header.read_text())
    header = folder / "broken_ik.hpp"
    header.write_text(BROKEN)
    with soak_program(replace(exact, header=header), QUICK) as program:
        yield program


@needs_compiler
def test_an_exact_arm_misses_nothing_at_any_singular_value(
    broken: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("BROKEN", raising=False)
    found = put_through(broken, POSES, NEAR)
    assert sum(d[0] for d in found.decades) == POSES and sum(d[3] for d in found.decades) == NEAR
    assert sum(d[3] > 20 for d in found.decades) > 8, "few decades are met"
    assert found.rows > 4 * POSES
    assert found.failures(0.0) == 0, "\n".join(table(found))


CAUGHT: dict[str, Callable[[Soak], bool]] = {
    "a row dropped": lambda s: s.wrong == 0 and sum(d[1] for d in s.decades) > 0,
    "no row": lambda s: sum(d[2] for d in s.decades) > 0.9 * POSES / 10,
    "a row moved": lambda s: s.wrong > POSES / 20,
}


@needs_compiler
@pytest.mark.parametrize("how", CAUGHT)
def test_what_is_wrong_is_noticed(broken: Path, monkeypatch: pytest.MonkeyPatch, how: str) -> None:
    monkeypatch.setenv("BROKEN", how)
    found = put_through(broken, POSES // 10, 100)
    assert CAUGHT[how](found), "\n".join(table(found))
    assert found.failures(ABOVE) > 0 and found.cases


def test_a_module_is_put_to_the_same(exact: Emitted, tmp_path: Path) -> None:
    found = soak_module(exact, 300, 300)
    assert sum(d[0] for d in found.decades) == sum(d[3] for d in found.decades) == 300
    assert found.rows > 1500 and sum(d[3] > 5 for d in found.decades) > 8
    assert found.failures(0.0) == 0, "\n".join(table(found))
    assert exact.module is not None
    text = exact.module.read_text()
    broken = tmp_path / "broken_ik.py"
    for line, caught in (
        ("rows[valid.sum(axis=1) > 4, 0, 1] += 1e-6", lambda s: s.wrong > 100),
        ("valid[:, 0] = False", lambda s: sum(d[1] + d[4] for d in s.decades) > 20),
        ("valid[:] = False", lambda s: sum(d[2] + d[5] for d in s.decades) > 500),
    ):
        last = '    return rows.reshape(DOF, -1, count).transpose(2, 1, 0), valid.copy("K"), '
        assert text.count(last) == 1
        own = "rows = rows.reshape(DOF, -1, count).transpose(2, 1, 0).copy()"
        changed = [own, "valid = valid.copy()", line, "return rows, valid, "]
        broken.write_text(text.replace(last, "\n".join(f"    {x}" for x in changed)))
        found = soak_module(replace(exact, module=broken), 300, 300)
        assert caught(found) and found.failures(ABOVE) > 0, "\n".join(table(found))


def test_failures_count_from_the_threshold_on() -> None:
    text = "rows 7 0\n" + "".join(f"decade {k} 10 {k == 2:d} 0 5 0 {k == 4:d}\n" for k in range(14))
    found = parsed(text + "missed 3e-3 0.1 0.2\n")
    assert [found.failures(above) for above in (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 0.0)] == [
        0,
        0,
        1,
        1,
        2,
        2,
    ]
    both = added([found, found])
    assert both.rows == 14 and both.decades[2] == (20, 2, 0, 10, 0, 0) and len(both.cases) == 2


def test_the_threshold_is_that_of_the_verification() -> None:
    assert ABOVE == completeness.FAILS_ABOVE


def test_an_arm_that_is_not_there(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit, match="no arm 'nowhere'"):
        main(["nowhere"])
    assert main([str(FIXTURES / "abb_yumi.urdf")]) == 2
    assert "chain" in capsys.readouterr().err
