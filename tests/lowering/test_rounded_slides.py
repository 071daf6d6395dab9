"""Slides of rounded arms: a length has no place on the unit circle that could be off."""

from __future__ import annotations

import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from ikgen.derivation.derive import derive
from ikgen.emit.python.python_emitter import emit_module
from ikgen.records.request import Request

_JOINT = """<joint name="j{i}" type="{type}"><parent link="l{before}"/><child link="l{i}"/>
<origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/></joint><link name="l{i}"/>"""


def test_a_slide_from_a_root_before_any_angle(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its length comes first, of a square root, where the position alone is read."""
    rows = [("revolute", "0 0 0", "0 0 0"), ("revolute", "0 0 0", "1.5708 0 0"),
            ("prismatic", "0 0 0", "1.5708 0 0"), ("fixed", "0.184 0 0", "0 0 0")]  # fmt: skip
    joints = [
        _JOINT.format(i=i + 1, before=i, type=type_, xyz=xyz, rpy=rpy)
        for i, (type_, xyz, rpy) in enumerate(rows)
    ]
    robot = tmp_path / "arm.urdf"
    robot.write_text(f'<robot name="r"><link name="l0"/>{"".join(joints)}</robot>')
    found = derive(Request(robot))
    text = emit_module(found.module)
    names: dict[str, Any] = {"__name__": "arm"}
    monkeypatch.setitem(sys.modules, "arm", ModuleType("arm"))
    exec(text, names)
    for q in np.random.default_rng(0).uniform(-0.9, 0.9, (20, 3)):
        pose = names["forward"](q)
        rows = names["solve"](pose).q
        assert np.abs(rows - q).max(axis=1).min() < 1e-9
        assert np.abs(names["forward"](rows)[:, :3, 3] - pose[:3, 3]).max() < 1e-9
