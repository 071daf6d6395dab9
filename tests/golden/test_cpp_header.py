"""The text of the C++ header of a hand-written Program; `IKGEN_UPDATE_GOLDEN=1` writes it anew."""

from __future__ import annotations

import os
from pathlib import Path

from tests.support.pan_lift import pan_lift

from ikgen.emit.cpp.cpp_emitter import emit_header

GOLDEN = Path(__file__).with_name("pan_lift_ik.hpp")


def test_header_is_the_golden_one() -> None:
    text = emit_header(pan_lift())
    if os.environ.get("IKGEN_UPDATE_GOLDEN"):
        GOLDEN.write_text(text)
    assert text == GOLDEN.read_text()
