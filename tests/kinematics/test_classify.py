"""The kinematic family of a chain, in words."""

from __future__ import annotations

from pathlib import Path

from tests.support.dh_files import dh_file

from ikgen.derivation.read import read
from ikgen.kinematics.classify import classify
from ikgen.records.request import Request

R = "revolute"


def test_parallel_axes_in_a_row_are_said_once(tmp_path: Path) -> None:
    links = [(R, 0.0, 0.0 if k == 0 else 0.3, 0.0, 0.0) for k in range(5)]
    turned = [*links[:4], (R, "pi/2", 0.1, 0.0, 0.0), (R, "pi/2", 0.0, 0.2, 0.0)]
    found = classify(read(Request(dh_file(tmp_path / "links.toml", links))).dh).words
    assert "axes 1-5 parallel" in found and "2-4" not in found, found
    found = classify(read(Request(dh_file(tmp_path / "turned.toml", turned))).dh).words
    assert "axes 1-4 parallel" in found and "axes 2-4" not in found, found
