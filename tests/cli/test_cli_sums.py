"""`--couple` of a joint that follows several others and has no motor: a linkage keeps it level."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.support.geared_arms import joint_values
from tests.support.redundant_arms import Joint, serial_urdf

from ikgen.cli.main import run
from ikgen.derivation.read import read
from ikgen.generation.emitted_checks import oracle_for
from ikgen.records.request import Request
from ikgen.verify.runners.python_module import PythonModule

pytestmark = pytest.mark.usefixtures("solved_once")

QUICK = ["--samples", "40", "-q"]
LEVEL = {"level": ({"elbow": -1.0, "shoulder": -1.0}, 0.0)}


def palletizer(level: tuple[float, float] = (-9.0, 9.0)) -> tuple[Joint, ...]:
    return (
        ("waist", "revolute", "0 0 1", "0 0 0.3", (-2.8, 2.8)),
        ("shoulder", "revolute", "0 1 0", "0.1 0 0", (-1.5, 1.5)),
        ("elbow", "revolute", "0 1 0", "0 0 0.5", (-2.4, 2.4)),
        ("level", "revolute", "0 1 0", "0.45 0 0", level),
        ("turn", "revolute", "0 0 1", "0.08 0 0", (-2.9, 2.9)),
    )


NAMES = [joint[0] for joint in palletizer()]
FREE = [name for name in NAMES if name != "level"]


@pytest.fixture
def robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "palletizer.urdf"
    path.write_text(serial_urdf("palletizer", palletizer()))
    return path


def values_of(q: np.ndarray) -> np.ndarray:
    """Those of all joints of the file."""
    every = np.insert(q, 3, 0.0, axis=-1)
    return joint_values(NAMES, LEVEL, every)


def test_a_level_tool_follows_shoulder_and_elbow(robot: Path) -> None:
    given = ["--couple", "level=elbow*-1-shoulder*1"]
    assert run(["from-urdf", str(robot), *given, "--task", "position-yaw", *QUICK]) == 0
    module = PythonModule(robot.with_name("palletizer_ik.py")).module
    assert list(module.JOINT_NAMES) == FREE
    plain = oracle_for(read(Request(robot)))
    rng = np.random.default_rng(0)
    low, high = module.LOWER, module.UPPER
    q = low + (high - low) * rng.uniform(0.02, 0.98, (60, 4))
    poses = plain.forward(values_of(q))
    np.testing.assert_allclose(module.forward(q), poses, atol=1e-12)
    for row, pose in zip(q, poses, strict=True):
        found = module.solve(pose, seed=row)
        assert np.abs(found.q - row).max(axis=1).min() < 1e-7
        reached = plain.forward(values_of(found.q))
        np.testing.assert_allclose(reached[:, :3, 3], found.q[:, :1] * 0 + pose[:3, 3], atol=1e-9)
        yaw = np.arctan2(reached[:, 1, 0], reached[:, 0, 0])
        asked = np.arctan2(pose[1, 0], pose[0, 0])
        np.testing.assert_allclose(np.exp(1j * yaw), np.exp(1j * asked), atol=1e-9)
    assert run(["verify", ".", "--samples", "20"]) == 0


@pytest.mark.parametrize(
    ("axis", "offset"),
    [("0 0 1", "+0.2"), pytest.param("0 0.2 1", "", marks=pytest.mark.long), ("0.2 0.2 1", "")],
)
def test_a_tool_off_level_has_a_heading_with_a_length(
    axis: str, offset: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "palletizer.urdf"
    joints = list(palletizer())
    joints[-1] = (*joints[-1][:2], axis, *joints[-1][3:])
    path.write_text(serial_urdf("palletizer", tuple(joints)))
    given = ["--couple", f"level=elbow*-1-shoulder*1{offset}", "-o", str(tmp_path)]
    assert run(["from-urdf", str(path), *given, "--task", "position-yaw", "--samples", "40"]) == 0
    assert "'position-yaw' fixes 5 freedoms and 4 joints move" in capsys.readouterr().err
    module = PythonModule(tmp_path / "palletizer_ik.py").module
    for turn in (
        1e-2,
        1e-3,
        1e-4,
    ):  # the x axis nearly horizontal: as short as it is, not a unit vector
        q = np.array([0.4, -0.3, 0.7, turn + (0.5 * np.pi if offset else 0.0)])
        assert np.abs(module.solve(module.forward(q), seed=q).q - q).max(axis=1).min() < 1e-9


def test_its_sources_may_have_motors_that_move_several(robot: Path) -> None:
    given = ["--couple", "level=elbow*-1+shoulder*-1", "--couple", "elbow=elbow*1-shoulder*1"]
    assert run(["from-urdf", str(robot), *given, "--task", "position-yaw", *QUICK]) == 0
    module = PythonModule(robot.with_name("palletizer_ik.py")).module
    motors = np.array([0.3, 0.4, 0.9, -0.5])
    joints = motors - [0.0, 0.0, 0.4, 0.0]
    pose = oracle_for(read(Request(robot))).forward(values_of(joints))
    np.testing.assert_allclose(module.forward(motors), pose, atol=1e-12)
    np.testing.assert_allclose(module.solve(pose, seed=motors)[0], motors, atol=1e-9)


def test_slides_add_up_too(tmp_path: Path) -> None:
    lift = (
        ("lift", "prismatic", "0 0 1", "0 0 0", (0.0, 0.4)),
        ("swing", "revolute", "0 0 1", "0.2 0 0", (-2.5, 2.5)),
        ("reach", "prismatic", "1 0 0", "0.2 0 0", (0.05, 0.3)),
        ("drop", "prismatic", "0 0 1", "0.1 0 0", (-5.0, 5.0)),
    )
    path = tmp_path / "lift.urdf"
    path.write_text(serial_urdf("lift", lift))
    given = ["--couple", "drop=lift*-0.5+reach*0.25+0.1", "-o", str(tmp_path), "--task", "position"]
    assert run(["from-urdf", str(path), *given, *QUICK]) == 0
    module = PythonModule(tmp_path / "lift_ik.py").module
    q = np.array([0.3, 0.7, 0.2])
    whole = np.append(q, -0.5 * 0.3 + 0.25 * 0.2 + 0.1)
    pose = oracle_for(read(Request(path))).forward(whole)
    np.testing.assert_allclose(module.forward(q), pose, atol=1e-12)
    np.testing.assert_allclose(module.solve(pose, seed=q)[0], q, atol=1e-9)
    np.testing.assert_allclose(module.LOWER, [0.0, -2.5, 0.05])
    np.testing.assert_allclose(module.UPPER, [0.4, 2.5, 0.3])


def test_rows_of_a_table_follow_several(tmp_path: Path) -> None:
    table = tmp_path / "plane.toml"
    row = '[[joints]]\nname = "q{}"\ntype = "revolute"\nalpha = 0\na = {}\nd = 0\ntheta = 0.1\n'
    rows = "".join(row.format(k, a) for k, a in enumerate((0, 0.4, 0.3), start=1))
    tool = "[tool]\nxyz = [0.2, 0.0, 0.0]\n"
    table.write_text(f'name = "plane"\nconvention = "modified"\n{rows}{tool}')
    given = ["--couple", "q3=q2*-1-q1*1+0.5", "-o", str(tmp_path), "--task", "position"]
    made = run(["from-dh", str(table), *given, *QUICK])
    assert made == 0
    module = PythonModule(tmp_path / "plane_ik.py").module
    q = np.array([0.3, 0.9])
    whole = np.append(q, 0.5 - q.sum())
    pose = oracle_for(read(Request(table))).forward(whole)
    np.testing.assert_allclose(module.forward(q), pose, atol=1e-12)
    np.testing.assert_allclose(module.solve(pose, seed=q)[0], q, atol=1e-9)


@pytest.mark.parametrize(
    ("options", "level", "words", "way_out"),
    [
        (["level=elbow*-1-shoulder*1"], (-2.0, 2.0), "from -3.9 to 3.9, beyond its limits (-2 to 2)",
         "limits in the file"),
        (["level=elbow*-1-shoulder*1", "turn=level*1"], (-9.0, 9.0),
         "'turn' follows 'level', which follows several", "--couple turn="),
        (["level=elbow*-1-shoulder*1", "turn=level*1+waist*1"], (-9.0, 9.0),
         "'turn' follows 'level', which follows several", "--couple turn="),
        (["level=elbow*-1-sholder*1"], (-9.0, 9.0), "no joint named 'sholder'", "shoulder"),
    ],
)  # fmt: skip
def test_what_cannot_be_followed_is_refused(
    options: list[str],
    level: tuple[float, float],
    words: str,
    way_out: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    path, out = tmp_path / "palletizer.urdf", tmp_path / "out"
    path.write_text(serial_urdf("palletizer", palletizer(level)))
    given = [x for text in options for x in ("--couple", text)]
    assert run(["from-urdf", str(path), *given, "-o", str(out)]) == 2
    said = capsys.readouterr().err
    assert words in said and way_out in said and not out.exists()


def test_moveit_has_no_model_of_it(robot: Path, capsys: pytest.CaptureFixture[str]) -> None:
    given = ["--couple", "level=elbow*-1-shoulder*1", "--emit", "moveit", *QUICK]
    assert run(["from-urdf", str(robot), *given]) == 2
    assert "a joint follows several others" in capsys.readouterr().err
