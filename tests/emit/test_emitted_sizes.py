"""How long emitted files are: a class of arms whose files grow says so here."""

from __future__ import annotations

from pathlib import Path

import pytest

from ikgen.derivation.derive import derive
from ikgen.emit.cpp.cpp_emitter import emit_header
from ikgen.emit.python.python_emitter import emit_module
from ikgen.records.request import Request

pytestmark = pytest.mark.usefixtures("solved_once")

FIXTURES = Path(__file__).parents[2] / "urdf_fixtures"
MOST = {  # bytes of the module and of the header, 2 % above what they were
    "abb_irb2400": (177_000, 163_000),
    "ur5e": (182_000, 167_000),
    "franka_fr3": (236_000, 238_000),
    "fanuc_crx10ia": (217_000, 274_000),
}


@pytest.mark.parametrize("robot", MOST)
def test_no_file_is_longer_than_its_class_had_it(robot: str) -> None:
    module = derive(Request(FIXTURES / f"{robot}.urdf")).module
    texts = emit_module(module), emit_header(module)
    for text, most in zip(texts, MOST[robot], strict=True):
        assert 0.9 * most < len(text.encode()) <= most  # a file that shrank lowers its bound
