"""Calibrations of single arms: origins of joints in YAML, offsets of DH rows in TOML."""

from __future__ import annotations

import json
import math
import re
import sys
from pathlib import Path

import numpy as np
import pytest

from ikgen.cli.main import run
from ikgen.derivation.derive import derive
from ikgen.derivation.read import read
from ikgen.errors import BadDescriptionError, UsageError
from ikgen.generation.emitted_checks import oracle_for
from ikgen.importers.calibration import row_offsets
from ikgen.kinematics.calibrated import offset_dh
from ikgen.kinematics.forward import file_forward, row_values
from ikgen.kinematics.rigid import dh_link
from ikgen.records.request import Request

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

pytestmark = pytest.mark.usefixtures("solved_once")

FIXTURES = Path(__file__).resolve().parents[2] / "urdf_fixtures"
UR5E = Request(FIXTURES / "ur5e.urdf", base="base_link", tip="tool0")
OWN = """
kinematics:
  shoulder: {x: 0, y: 0, z: 0.16236, roll: 0, pitch: 0, yaw: 2.1e-05}
  upper_arm: {x: 0.00013, y: 0, z: 0, roll: 1.57138, pitch: 0, yaw: -3.4e-05}
  forearm: {x: -0.42487, y: 0, z: 0, roll: 0.00073, pitch: -0.00041, yaw: 1.2e-05}
  wrist_1: {x: -0.39231, y: 0.00021, z: 0.13342, roll: -0.00118, pitch: 0.0006, yaw: -2e-05}
  wrist_2: {x: 4.1e-05, y: -0.09967, z: 8.8e-05, roll: 1.56991, pitch: 0, yaw: 6e-06}
  wrist_3: {x: -2.6e-05, y: 0.09953, z: -6.1e-05, roll: 1.57141, pitch: 3.141592653589793, yaw: 3.14156}
  hash: calib_1
"""


def calibrated(text: str, folder: Path, request: Request = UR5E, suffix: str = "yaml") -> Request:
    path = folder / f"own.{suffix}"
    path.write_text(text)
    values = {name: getattr(request, name) for name in ("robot", "base", "tip")}
    return Request(**values, calibration=path)


def test_the_chain_is_the_arms_own_and_the_rows_are_the_models(tmp_path: Path) -> None:
    model, own = read(UR5E), read(calibrated(OWN, tmp_path))
    alike = [(r.alpha.exact, r.a.name, r.d.name) for r in own.dh.rows]
    assert alike == [(r.alpha.exact, r.a.name, r.d.name) for r in model.dh.rows]
    q = np.random.default_rng(0).uniform(-3, 3, (20, 6))
    assert np.abs(file_forward(own.dh, q) - oracle_for(own).forward(q)).max() < 1e-14
    off = np.abs(file_forward(own.dh, q) - file_forward(model.dh, q)).max()
    assert 1e-4 < off < 1e-2 and 1e-4 < max(own.dh.deviation) < 1e-2
    assert own.source.sha256 != model.source.sha256
    assert (tmp_path / "own.yaml").resolve() in own.source.dependencies


def test_the_closed_form_is_that_of_the_models_class(tmp_path: Path) -> None:
    own = derive(calibrated(OWN, tmp_path)).module
    assert not any("elimination" in step for step in own.order)
    assert len(own.order) == len(derive(UR5E).module.order) and own.rounded


def test_the_origins_are_those_of_the_file(tmp_path: Path) -> None:
    tree = read(calibrated(OWN, tmp_path)).tree
    assert tree is not None
    wrist = next(joint for joint in tree.joints if joint.child == "wrist_1_link")
    assert wrist.T_parent_child[:3, 3].tolist() == [-0.39231, 0.00021, 0.13342]
    assert wrist.T_parent_child[2, 1] == pytest.approx(math.sin(-0.00118) * math.cos(0.0006))


def test_what_the_description_asked_of_its_environment_is_kept(tmp_path: Path) -> None:
    text = UR5E.robot.read_text().replace('<robot name="ur5e"', '<robot name="$(optenv ARM ur5e)"')
    robot = tmp_path / "ur5e.urdf.xacro"
    robot.write_text(text)
    request = Request(robot, base="base_link", tip="tool0")
    assert [name for name, _ in read(request).source.environment] == ["ARM"]
    own = read(calibrated(OWN, tmp_path, request))
    assert own.source.environment == read(request).source.environment


def test_offsets_of_rows_are_added(tmp_path: Path) -> None:
    rows = "".join(
        f"[[joints]]\nalpha = {k}e-4\na = 2e-4\ntheta = -1e-3\nd = 3e-4\n" for k in range(6)
    )
    model, own = read(UR5E), read(calibrated(rows, tmp_path, suffix="toml"))
    assert own.dh.rows == model.dh.rows and own.tree is None
    q = np.random.default_rng(0).uniform(-3, 3, (8, 6))
    T = np.eye(4)
    for i, (F, row) in enumerate(zip(model.dh.file_frames[:-1], model.dh.rows, strict=True)):
        alpha, v = i * 1e-4, row.scale * q[:, row.driver] + row.offset.value - 1e-3
        c, s = math.cos(alpha), math.sin(alpha)
        twist = np.array([[1, 0, 0, 2e-4], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1]])
        turn = np.zeros((len(q), 4, 4))
        turn[:, 0, 0] = turn[:, 1, 1] = np.cos(v)
        turn[:, 1, 0], turn[:, 0, 1] = np.sin(v), -np.sin(v)
        turn[:, 2, 2] = turn[:, 3, 3] = 1.0
        turn[:, 2, 3] = 3e-4
        T = T @ (F @ twist if i == 0 else twist @ F) @ turn
    T = T @ model.dh.file_frames[-1]
    assert np.abs(file_forward(own.dh, q) - T).max() < 1e-14
    assert np.abs(oracle_for(own).forward(q) - T).max() < 1e-14


def test_it_is_told_how_far_a_calibration_is_off(tmp_path: Path) -> None:
    near = read(calibrated(OWN, tmp_path))
    assert near.calibration is not None and not near.calibration.far
    assert min(near.calibration.off) > 1e-3 and max(near.calibration.off) < 1e-2
    assert near.source.warnings == read(UR5E).source.warnings
    gross = read(calibrated(OWN.replace("roll: 1.57138", "roll: 0.7"), tmp_path))
    assert gross.calibration is not None and gross.calibration.off[1] == pytest.approx(
        0.87, abs=0.01
    )
    assert " m and 0.87 rad off the model; arms are " in gross.source.warnings[-1]


def test_summary_and_json_have_the_calibration(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    request = calibrated("[[joints]]\na = 0.1\n" + 3 * "[[joints]]\n", tmp_path, suffix="toml")
    words = ["from-dh", str(FIXTURES / "scara_standard.toml"), "--no-verify", "-o", str(tmp_path)]
    words += ["--calibration", str(request.calibration)]
    assert run(words) == 0
    said = capsys.readouterr()
    assert re.search(r"calibrated: +\S*own.toml: up to 0.1 m and \S+ rad off the model", said.out)
    assert "warning: " in said.err and "own.toml: up to 0.1 m" in said.err
    assert run([*words, "--json", "-q"]) == 0
    assert json.loads(capsys.readouterr().out)["calibration"]["m"] == pytest.approx(0.1)


def test_inspect_says_that_the_rows_are_one_arms_own(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    request = calibrated("[[joints]]\na = 1e-3\n" + 3 * "[[joints]]\n", tmp_path, suffix="toml")
    words = ["inspect", str(FIXTURES / "scara_standard.toml"), "--no-advice"]
    assert run(words) == 0
    assert "calibrated" not in capsys.readouterr().out
    words += ["--calibration", str(request.calibration)]
    assert run(words) == 0
    said = re.search(r"^calibrated: (.*)$", capsys.readouterr().out, re.MULTILINE)
    assert said and said[1].endswith("own.toml: up to 0.001 m and 0 rad off the model")
    assert run([*words, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["chain"]["calibration"] == said[1]


def test_the_page_on_fleets_has_a_row_for_each_of_the_arm() -> None:
    page = FIXTURES.parent / "docs" / "how-to" / "calibrated-fleets.md"
    texts = re.findall(r'```toml title="rows.toml"\n(.*?)```', page.read_text(), re.DOTALL)
    assert [len(tomllib.loads(text)["joints"]) for text in texts] == [len(read(UR5E).dh.rows)]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("kinematics: [1]", "no table 'kinematics'"),
        ("shoulder: 1", "no table 'kinematics'"),
        ("kinematics: {hash: calib_1}", "names no link"),
        ("", "the file is empty"),
        (
            "kinematics: {elbow: {x: 0, y: 0, z: 0, roll: 0, pitch: 0, yaw: 0}}",
            "no link 'elbow_link'",
        ),
        ("kinematics: {shoulder: {x: 0}}", "has not the numbers"),
        (OWN.replace("0.16236", "high"), "shoulder.z .* not a finite number"),
        (OWN.replace("0.16236", "9" * 400), "shoulder.z .* not a finite number"),
        ("kinematics: {", "not YAML"),
        (OWN.replace("forearm:", "shoulder:"), ":5: the calibration has 'shoulder' twice"),
    ],
)
def test_what_is_no_calibration_is_refused(text: str, said: str, tmp_path: Path) -> None:
    with pytest.raises(BadDescriptionError, match=said) as caught:
        read(calibrated(text, tmp_path))
    assert "own.yaml" in caught.value.message


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[[joints]]\na = 1\n", "no calibration of 2 rows"),
        ("[[joints]]\nb = 1\n[[joints]]\n", "unknown entry 'b'"),
        ("[[joints]]\na = 'x'\n[[joints]]\n", "not a finite number"),
        (f"[[joints]]\na = {10**400}\n[[joints]]\n", "row 1, a .* not a finite number"),
        ("[[joints]\n", "not TOML"),
        ("\ufeff[[joints]]\nb = 1\n[[joints]]\n", "unknown entry 'b'"),
        ("convention = 'craig'\n[[joints]]\n[[joints]]\n", "convention is 'craig'"),
        ("convention = 'standard'\n[[joints]]\n[[joints]]\n", "not read from a table of such"),
    ],
)
def test_what_are_no_offsets_is_refused(text: str, said: str, tmp_path: Path) -> None:
    (tmp_path / "own.toml").write_text(text)
    with pytest.raises(BadDescriptionError, match=said):
        row_offsets(tmp_path / "own.toml", 2)


def test_a_table_takes_offsets_only(tmp_path: Path) -> None:
    table = Request(FIXTURES / "scara_standard.toml")
    with pytest.raises(UsageError, match="offsets of its rows"):
        read(calibrated(OWN, tmp_path, table))


@pytest.mark.parametrize(
    ("was", "now", "said"),
    [
        ("-0.42487", "-424.87", "joint 'elbow_joint': its origin 424.87 m away looks like mm"),
        ("roll: 1.57138", "roll: 90", "rpy 90 0 -3.4e-05 looks like degrees"),
    ],
)
def test_units_that_look_wrong_are_told_of_its_own_file(
    was: str, now: str, said: str, tmp_path: Path
) -> None:
    known = read(UR5E).source.warnings
    found = read(calibrated(OWN.replace(was, now), tmp_path)).source.warnings
    new = [one for one in found if one not in known]
    assert any(said in one for one in new)
    assert all(one.startswith(f"{tmp_path / 'own.yaml'}: ") for one in new)


def test_what_cannot_be_is_told_of_its_own_file(tmp_path: Path) -> None:
    with pytest.raises(BadDescriptionError) as caught:
        read(calibrated(OWN.replace("0.13342", "133420"), tmp_path))
    assert caught.value.file == str(tmp_path / "own.yaml")


@pytest.mark.parametrize("name", ["puma560_paper", "scara_standard"])
def test_offsets_are_those_of_rows_with_the_numbers_added(name: str) -> None:
    dh = read(Request(FIXTURES / f"{name}.toml")).dh
    q = np.random.default_rng(0).uniform(-1.0, 1.0, dh.dof)
    for i, row in enumerate(dh.rows):
        for entry in ("alpha", "a", "d", "theta"):
            offsets = [dict.fromkeys(("alpha", "a", "d", "theta"), 0.0) for _ in (*dh.rows, "tip")]
            offsets[i][entry] = 3e-3
            T = np.array(dh.X_base)
            for one, other, value in zip(dh.rows, offsets[:-1], row_values(dh, q), strict=True):
                theta, d = (value, one.d.nominal) if one.revolute else (one.theta.value, value)
                T = T @ dh_link(
                    one.alpha.value + other["alpha"],
                    one.a.nominal + other["a"],
                    theta + other["theta"],
                    d + other["d"],
                )
            got = file_forward(offset_dh(dh, offsets), q)
            assert np.abs(got - T @ dh.X_tip).max() < 1e-12, (row.name, entry)


def test_offsets_of_standard_rows_are_those_of_the_table_with_the_numbers_added(
    tmp_path: Path,
) -> None:
    """Rows of Denavit and Hartenberg (1955): Rz(theta) Tz(d) Tx(a) Rx(alpha)."""
    rows = [(0.4, 0.1, 1.5707963267948966), (0.05, 0.4, 0.3), (0.1, 0.2, -0.7)]
    off = [{"alpha": 1e-3, "d": 2e-4}, {"a": -3e-4, "theta": 2e-3}, {"alpha": 4e-3, "a": 5e-4}]
    lines = ['convention = "standard"']
    offsets = list(lines)
    for (d, a, alpha), one in zip(rows, off, strict=True):
        lines += ["[[joints]]", 'type = "revolute"', f"alpha = {alpha}", f"a = {a}", f"d = {d}"]
        offsets += ["[[joints]]", *(f"{name} = {value}" for name, value in one.items())]
    table, own = tmp_path / "arm.toml", tmp_path / "own.toml"
    table.write_text("\n".join(['name = "arm"', *lines]))
    own.write_text("\n".join(offsets))
    dh = read(Request(table, calibration=own)).dh
    q = np.array([0.3, -0.8, 1.1])
    T = np.eye(4)
    for (d, a, alpha), one, turn in zip(rows, off, q, strict=True):
        T = T @ dh_link(0.0, 0.0, turn + one.get("theta", 0.0), d + one.get("d", 0.0))
        T = T @ dh_link(alpha + one.get("alpha", 0.0), a + one.get("a", 0.0), 0.0, 0.0)
    np.testing.assert_allclose(file_forward(dh, q), T, atol=1e-14)
