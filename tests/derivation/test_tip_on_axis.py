"""What is told where the last joint turns about the tip's own origin."""

from __future__ import annotations

from pathlib import Path

import pytest

from ikgen.cli.main import run
from ikgen.derivation.announcements import announcements
from ikgen.derivation.derive import derive
from ikgen.records.request import Request

X, Y, Z = "1 0 0", "0 1 0", "0 0 1"
LEG, FINGER, PAN_TILT = (
    [(Z, 0.1), (X, 0.2), (X, 0.3)],
    [(X, 0.1), (X, 0.2), (X, 0.3)],
    [(Z, 0.1), (X, 0.0)],
)


def robot(folder: Path, joints: list[tuple[str, float]], foot: str = "") -> Path:
    """Revolute joints about the axes, each so far down from the one before; a foot fixed at `foot`."""
    text = '<robot name="leg"><link name="link0"/>'
    for i, (axis, down) in enumerate(joints, 1):
        text += (
            f'<link name="link{i}"/><joint name="j{i}" type="revolute"><parent link="link{i - 1}"/>'
            f'<child link="link{i}"/><origin xyz="0.03 0 {-down}"/><axis xyz="{axis}"/>'
            '<limit lower="-1.5" upper="1.5"/></joint>'
        )
    if foot:
        text += (
            f'<link name="foot"/><joint name="sole" type="fixed"><parent link="link{len(joints)}"/>'
            f'<child link="foot"/><origin xyz="{foot}"/></joint>'
        )
    path = folder / "leg.urdf"
    path.write_text(f"{text}</robot>")
    return path


def told(request: Request) -> str:
    return "\n".join(t for t in announcements(derive(request)) if "its own origin" in t)


@pytest.mark.parametrize(("joints", "foot"), [(LEG, ""), (FINGER, ""), (LEG, "0.1 0 0")])
def test_a_leg_without_a_foot_is_told_of(
    tmp_path: Path, joints: list[tuple[str, float]], foot: str
) -> None:
    tip = "foot" if foot else "link3"
    words = told(Request(robot(tmp_path, joints, foot)))
    assert words.startswith(f"'j3' turns '{tip}' about its own origin, which stays where it is")
    assert "--tip" in words


@pytest.mark.parametrize(
    ("joints", "foot"), [(LEG, "0 0 -0.3"), (FINGER, "0 0 -0.3"), (PAN_TILT, "")]
)
def test_a_foot_or_a_camera_where_it_belongs_is_not(
    tmp_path: Path, joints: list[tuple[str, float]], foot: str
) -> None:
    assert told(Request(robot(tmp_path, joints, foot))) == ""


def test_who_asks_for_the_rotation_is_told_nothing(tmp_path: Path) -> None:
    assert told(Request(robot(tmp_path, LEG), task="rotation")) == ""


def test_inspect_tells_it_too(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["inspect", str(robot(tmp_path, FINGER))]) == 0
    assert "'j3' turns 'link3' about its own origin" in capsys.readouterr().out
