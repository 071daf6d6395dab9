"""What errors of a tip's position are relative to."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from tests.support.solving import FIXTURES
from tests.support.tables import table

from ikgen.generation.generate import generate
from ikgen.kinematics.position_unit import position_unit
from ikgen.records.request import Outputs, Request

pytestmark = pytest.mark.usefixtures("solved_once")


def test_it_is_the_longest_link_and_a_metre_for_small_arms() -> None:
    assert position_unit(table(("R", "0", 0.2, 0.0), ("R", "1", 0.3, 0.1))) == 1.0
    assert position_unit(table(("R", "0", 2.25, 0.0), ("R", "1", 1.5, 0.5))) == 2.25
    assert position_unit(table(("P", "0", 0.0, 0.0), ("R", "1", 3.0, 0.0))) == pytest.approx(3.0)


def test_tiny_arms_have_a_unit_of_their_own() -> None:
    tiny = table(("R", "0", 0.02, 0.0), ("R", "1", 0.03, 0.01))
    assert position_unit(tiny) == pytest.approx(0.03)
    on_a_slide = table(("P", "0", 0.0, 0.0), ("R", "1", 0.03, 0.0))
    assert position_unit(on_a_slide) == 1.0


def test_an_arm_in_the_size_of_a_watch_is_verified(tmp_path: Path) -> None:
    """Its rows are singular where those of the same arm in metres are."""
    text = (FIXTURES / "fanuc_crx10ia.urdf").read_text("utf-8")

    def smaller(found: re.Match[str]) -> str:
        return f'{found[1]}xyz="{" ".join(str(float(x) / 100) for x in found[2].split())}"'

    path = tmp_path / "tiny.urdf"
    path.write_text(re.sub(r'(<origin [^>]*)xyz="([^"]*)"', smaller, text), "utf-8")
    made = generate(Request(path), Outputs(out=tmp_path, samples=20))
    assert made.reports["python"].passed
    assert made.derivation.module.size < 0.05


def test_frames_far_out_along_axes_do_not_count() -> None:
    """Offsets of 50 m to and fro along parallel axes, of an arm that reaches 1.7 m."""
    far = table(("R", "0", 0.3, 50.0), ("R", "0", 1.2, -50.0), ("R", "1", 0.2, 0.0))
    assert position_unit(far) == pytest.approx(1.5, abs=0.31)
