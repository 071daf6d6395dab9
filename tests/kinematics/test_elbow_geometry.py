"""Which arms have an arm angle, and what those lack that have none."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from tests.support.redundant_arms import (
    OFFSET_ELBOW,
    SHOULDER_ELBOW_WRIST,
    TORSO,
    serial_urdf,
)

from ikgen.derivation.read import read
from ikgen.errors import UsageError
from ikgen.kinematics.elbow_geometry import elbow_geometry, without_arm_angle
from ikgen.model.dh import DHChain
from ikgen.records.request import Request

UPRIGHT = SHOULDER_ELBOW_WRIST


def rows(tmp_path: Path, joints: tuple[tuple[object, ...], ...]) -> DHChain:
    path = tmp_path / "arm.urdf"
    path.write_text(serial_urdf("arm", joints))  # type: ignore[arg-type]
    return read(Request(path)).dh


def moved(joint: int, xyz: str) -> tuple[tuple[object, ...], ...]:
    changed = (*UPRIGHT[joint][:3], xyz, UPRIGHT[joint][4])
    return (*UPRIGHT[:joint], changed, *UPRIGHT[joint + 1 :])


def test_links_are_measured(tmp_path: Path) -> None:
    found = elbow_geometry(rows(tmp_path, OFFSET_ELBOW))
    assert found.upper == pytest.approx((0.08**2 + 0.4**2) ** 0.5)
    assert found.fore == pytest.approx((0.05**2 + 0.35**2) ** 0.5)
    assert found.shoulder[:3, 3] == pytest.approx([0.0, 0.0, 0.3])
    assert found.shoulder[:3, 2] == pytest.approx([0.0, 0.0, -1.0])
    assert found.wrist == pytest.approx([0.0, 0.0, -0.1])


@pytest.mark.parametrize(
    ("joints", "words"),
    [
        (UPRIGHT[:6], "seven joints that turn"),
        ((TORSO, *UPRIGHT), "seven joints that turn"),
        (moved(1, "0.05 0 0"), "a spherical shoulder: axes 1, 2 and 3"),
        (moved(6, "0.05 0 0"), "a spherical wrist: axes 5, 6 and 7"),
        (moved(3, "0 0 0"), "links between shoulder, elbow and wrist"),
    ],
)
def test_what_is_lacking_is_said(
    joints: tuple[tuple[object, ...], ...], words: str, tmp_path: Path
) -> None:
    dh = rows(tmp_path, joints)
    assert words in without_arm_angle(dh)
    with pytest.raises(UsageError, match="--free arm-angle: the arm lacks") as caught:
        elbow_geometry(dh)
    assert "ikgen chooses" in str(caught.value.hint)


def test_a_joint_held_beside_it_leaves_none_to_spare(tmp_path: Path) -> None:
    dh = replace(rows(tmp_path, UPRIGHT), free=("wrist_roll", "arm-angle"))
    assert without_arm_angle(dh) == "a joint to spare: with wrist_roll held there is none"
