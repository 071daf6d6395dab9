"""How long emitted files are: a class of arms whose files grow says so here."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from ikgen.derivation.derive import derive
from ikgen.emit.cpp.cpp_emitter import emit_header
from ikgen.emit.python.python_emitter import emit_module
from ikgen.records.request import Request

pytestmark = pytest.mark.usefixtures("solved_once")

ROOT = Path(__file__).parents[2]
FIXTURES = ROOT / "urdf_fixtures"
MOST = {  # bytes of the module and of the header, about what they are
    "abb_irb2400": (177_000, 167_000),
    "ur5e": (182_500, 171_000),
    "franka_fr3": (236_000, 240_000),
    "fanuc_crx10ia": (217_000, 277_000),
}


def emitted(robot: str) -> tuple[int, int]:
    """Bytes of an arm's module and of its header."""
    module = derive(Request(FIXTURES / f"{robot}.urdf")).module
    return len(emit_module(module).encode()), len(emit_header(module).encode())


@pytest.mark.parametrize("robot", MOST)
def test_no_file_is_longer_than_its_class_had_it(robot: str) -> None:
    for size, most in zip(emitted(robot), MOST[robot], strict=True):
        assert 0.9 * most < size <= most  # a file that shrank lowers its bound


@pytest.mark.parametrize("robot", ["ur5e", "franka_fr3"])
def test_the_readme_says_how_long_they_are(robot: str) -> None:
    text = " ".join((ROOT / "README.md").read_text().split())
    said = re.search(rf"/{robot}\.urdf`[^.]*? (\d+) kB(?: of Python)? or (\d+) kB", text)
    assert said is not None
    assert [int(kilobytes) for kilobytes in said.groups()] == [
        pytest.approx(size / 1000, rel=0.02) for size in emitted(robot)
    ]
