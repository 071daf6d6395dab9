"""Tools a fifth of a millimetre beside the last axis: what follows from that lever has lost digits."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.support.solving import import_text

from ikgen.emit.cpp.cpp_emitter import emit_header
from ikgen.emit.python.python_emitter import emit_module
from ikgen.generation.derive import derive
from ikgen.generation.request import Request

_JOINTS = (
    ("0 0 0.1", "0 0 0"),
    ("0.03 0 0", "1.5707963267948966 0 0"),
    ("0.116 0 0", "0 0 0"),
    ("0.135 0 0", "0 0 0"),
    ("0 0 0", "1.5707963267948966 0 0"),
)
_TIP = (
    '<link name="tip"/><joint name="tool" type="fixed"><parent link="link5"/><child link="tip"/>'
    '<origin xyz="0.0079 0.000218121 -0.1592274" rpy="0 0 0"/></joint>'
)
ARM = "\n".join(
    [
        '<robot name="slender"><link name="link0"/>',
        *(
            f'<link name="link{i}"/><joint name="joint{i}" type="revolute">'
            f'<parent link="link{i - 1}"/><child link="link{i}"/><origin xyz="{xyz}" rpy="{rpy}"/>'
            '<axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>'
            for i, (xyz, rpy) in enumerate(_JOINTS, 1)
        ),
        _TIP,
        "</robot>",
    ]
)


@pytest.mark.parametrize("decade", [4, 5, 6, 8, 10])
def test_poses_beside_a_stretched_elbow_have_rows(decade: int, tmp_path: Path) -> None:
    robot = tmp_path / "slender.urdf"
    robot.write_text(ARM)
    derivation = derive(Request(robot))
    assert derivation.module.reads.name == "position-direction:x"
    arm = import_text(emit_module(derivation.module), tmp_path)
    q = np.random.default_rng(decade).uniform(-1.5, 1.5, (25, 5))
    q[:, 2] = 10.0**-decade
    for row, found in zip(q, arm.solve_batch(arm.forward(q), limits=False)[0], strict=True):
        gap = np.abs(np.remainder(found - row + np.pi, 2 * np.pi) - np.pi).max(axis=1)
        assert (
            np.nanmin(gap, initial=np.inf) < 5e-5
        )  # by so much a row that is right to 1e-10 may be off


def test_its_rows_take_newton_steps_all_at_once(tmp_path: Path) -> None:
    """In the header; those of the same arm without the lever are right as they are."""
    robot = tmp_path / "slender.urdf"
    for text, coarse in ((ARM, True), (ARM.replace("0.0079 0.000218121", "0 0"), False)):
        robot.write_text(text)
        module = derive(Request(robot)).module
        assert module.refine == "some" and module.program.coarse == coarse
        assert f"kNewton = {str(coarse).lower()};" in emit_header(module)
