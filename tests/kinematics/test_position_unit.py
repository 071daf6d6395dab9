"""What errors of a tip's position are relative to."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tests.support.solving import FIXTURES
from tests.support.tables import table

from ikgen.generation.generate import generate
from ikgen.kinematics.position_unit import position_unit
from ikgen.model.dh import DHChain
from ikgen.records.request import Outputs, Request

pytestmark = pytest.mark.usefixtures("solved_once")


def test_it_is_the_longest_link_and_a_metre_for_small_arms() -> None:
    assert position_unit(table(("R", "0", 0.2, 0.0), ("R", "1", 0.3, 0.1))) == 1.0
    assert position_unit(table(("R", "0", 2.25, 0.0), ("R", "1", 1.5, 0.5))) == 1.5
    assert position_unit(table(("R", "0", 0.0, 0.0), ("R", "1", 2.25, 0.5))) == 2.25
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


def test_where_an_arm_stands_does_not_count_but_for_the_digits_it_takes(tmp_path: Path) -> None:
    """Positions as surveyors measure them: poses are 5 km from their frame."""
    near = table(("R", "0", 0.2, 0.0), ("R", "1", 0.3, 0.1))

    def standing(away: float) -> DHChain:
        frames = np.array(near.file_frames)
        frames[0, 0, 3] = away
        return replace(near, file_frames=tuple(frames))

    assert position_unit(standing(5e3)) == 1.0
    assert position_unit(standing(5e5)) == pytest.approx(50.0)
    text = (FIXTURES / "ur5e.urdf").read_text("utf-8")
    place = '<link name="survey"/><joint name="place" type="fixed"><parent link="survey"/>'
    place += '<child link="world"/><origin xyz="4512.3 -3381.7 91.4" rpy="0 0 0"/></joint></robot>'
    path = tmp_path / "far.urdf"
    path.write_text(text.replace("</robot>", place), "utf-8")
    made = generate(Request(path, base="survey"), Outputs(out=tmp_path, samples=200))
    assert made.derivation.module.size == 1.0 and made.reports["python"].passed
