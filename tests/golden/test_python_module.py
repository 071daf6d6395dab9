"""The text of the Python module of a hand-written Program; `IKGEN_UPDATE_GOLDEN=1` writes it anew."""

from __future__ import annotations

import os
from pathlib import Path

from tests.support.pan_lift import pan_lift

from ikgen.emit.python.python_emitter import emit_module

GOLDEN = Path(__file__).with_name("pan_lift_ik.py")


def test_module_is_the_golden_one() -> None:
    text = emit_module(pan_lift())
    if os.environ.get("IKGEN_UPDATE_GOLDEN"):
        GOLDEN.write_text(text, encoding="utf-8")
    assert text == GOLDEN.read_text(encoding="utf-8")
