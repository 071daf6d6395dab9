"""`--couple` with several sources: what motors move a joint by, and what was made is checked by it."""

from __future__ import annotations

import importlib.util
import json
import shutil
from pathlib import Path

import numpy as np
import pytest
from tests.support.geared_arms import (
    BELTS,
    SCARA,
    SCARA_JOINTS,
    SIX,
    couple_options,
    joint_values,
)
from tests.support.redundant_arms import SHOULDER_ELBOW_WRIST, serial_urdf

import ikgen
from ikgen.cli.main import run
from ikgen.derivation.read import read
from ikgen.generation.emitted_checks import oracle_for
from ikgen.records.request import Request
from ikgen.verify.runners import cpp_toolchain
from ikgen.verify.runners.cpp_toolchain import LIGHT
from ikgen.verify.runners.python_module import PythonModule

pytestmark = pytest.mark.usefixtures("solved_once")

QUICK = ["--samples", "40", "-q"]
OPTIONS = couple_options(BELTS)


@pytest.fixture
def scara(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "scara.urdf"
    path.write_text(SCARA)
    return path


def test_what_is_made_has_the_values_of_motors_and_is_checked_again(scara: Path) -> None:
    assert (
        run(["from-urdf", str(scara), *OPTIONS, "--emit", "python,cpp", "--no-verify", "-q"]) == 0
    )
    module = PythonModule(scara.with_name("scara_ik.py")).module
    assert module.JOINT_NAMES == SCARA_JOINTS
    motors = np.array([0.4, 0.9, 20.0, -1.2])
    values = joint_values(SCARA_JOINTS, BELTS, motors)
    np.testing.assert_allclose(
        module.TRANSMISSION @ motors + module.TRANSMISSION_OFFSET, values, atol=1e-12
    )
    pose = oracle_for(read(Request(scara))).forward(values)
    np.testing.assert_allclose(module.forward(motors), pose, atol=1e-12)
    found = module.solve(pose, seed=motors)
    assert len(found) == 2
    np.testing.assert_allclose(found[0], motors, atol=1e-9)
    record = json.loads(scara.with_name("scara_ik.json").read_text())
    assert record["couple"]["outer"] == "outer*1.0+inner*-1.0+0.1"
    assert run(["verify", ".", "--samples", "20"]) == 0


def test_it_is_told_by_the_summary_the_report_and_inspect(
    scara: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    told = ["outer=inner*-1+outer*1+0.1", "spline=spline*0.003+quill*0.0005"]
    assert run(["from-urdf", str(scara), *OPTIONS, "--samples", "20"]) == 0
    assert all(text in capsys.readouterr().out for text in told[:1])
    assert run(["inspect", str(scara), *OPTIONS, "--no-advice"]) == 0
    shown = capsys.readouterr().out
    assert all(text in shown for text in told)
    assert run(["inspect", str(scara), *OPTIONS, "--no-advice", "--json"]) == 0
    assert set(told) <= set(json.loads(capsys.readouterr().out)["chain"]["motors"])
    assert run(["report", str(scara), *OPTIONS, "-o", "pages", "-q"]) == 0
    page = next(scara.parent.joinpath("pages").glob("*.tex")).read_text()
    assert "from the motors' values m" in page and r"{q_{3}=0.003\,m_{3}+0.0005\,m_{4}}" in page
    assert "{q_{2}=-m_{1}+m_{2}+0.1}" in page


def test_held_values_are_of_the_joints(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    path, names = tmp_path / "seven.urdf", [joint[0] for joint in SHOULDER_ELBOW_WRIST]
    path.write_text(serial_urdf("seven", SHOULDER_ELBOW_WRIST))
    sources = {"shoulder_roll": ({"shoulder_roll": 0.5, "shoulder_pitch": 1.0}, 0.0)}
    options = ["--free", "shoulder_roll", *couple_options(sources), *QUICK]
    assert run(["from-urdf", str(path), *options]) == 0
    module = PythonModule(tmp_path / "seven_ik.py").module
    motors = np.array([0.3, 0.7, 0.4, 0.8, -0.4, 0.9, 0.2])
    held = joint_values(names, sources, motors)[2]
    pose = module.forward(motors)
    for found in (module.solve(pose, free=[held], seed=motors), module.solve(pose, seed=motors)):
        np.testing.assert_allclose(found[0], motors, atol=1e-9)
        np.testing.assert_allclose(joint_values(names, sources, found.q)[:, 2], held, atol=1e-12)
    assert any(one.low <= held <= one.high for one in module.self_motion(pose))


@pytest.mark.parametrize(
    ("options", "words", "way_out"),
    [
        (["elbow=elbow*1+shoulder_pitch*-1", "shoulder_pitch=elbow*2+shoulder_pitch*-2"],
         "do not tell their motors apart", "solved for"),
        (["elbow=elbow*1+shoulder*-1"], "no joint named 'shoulder'", "there is"),
        (["elbow=elbow*1"], "'elbow' follows itself", "another joint"),
        (["elbow=shoulder_pitch*1", "wrist_yaw=wrist_yaw*1+elbow*1"],
         "'elbow' follows another", "the joint that it follows"),
        (["elbow=elbow*1+wrist_yaw*0"], "'wrist_yaw' has the factor 0", "for example"),
    ],
)  # fmt: skip
def test_what_cannot_be_solved_for_the_motors_is_refused(
    options: list[str],
    words: str,
    way_out: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    path = tmp_path / "six.urdf"
    path.write_text(SIX)
    given = [x for text in options for x in ("--couple", text)]
    assert run(["from-urdf", str(path), *given, "-o", str(tmp_path / "out")]) == 2
    said = capsys.readouterr().err
    assert words in said and way_out in said and not (tmp_path / "out").exists()


def test_a_locked_joint_has_no_motor(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "six.urdf"
    path.write_text(SIX)
    given = ["--couple", "elbow=elbow*1+shoulder_pitch*-1", "--lock", "elbow=1"]
    assert run(["from-urdf", str(path), *given, "-o", str(tmp_path / "out")]) == 2
    assert "'elbow' is locked" in capsys.readouterr().err


def test_a_config_and_the_library_take_the_same_relations(scara: Path) -> None:
    texts = [text.partition("=") for text in OPTIONS[1::2]]
    relations = {joint: right for joint, _, right in texts}
    table = ", ".join(f'{joint} = "{text}"' for joint, text in relations.items())
    head = '[[arm]]\nname = "belts"\nrobot = "scara.urdf"\nsamples = 20\n'
    scara.with_name("ikgen.toml").write_text(f"{head}couple = {{ {table} }}\n")
    assert run(["build", "-q"]) == 0
    assert run(["build", "--check"]) == 0
    module = PythonModule(scara.with_name("belts_ik.py")).module
    arm = ikgen.load("scara.urdf", couple=relations, verify=False, cache=False)
    motors = np.array([0.4, 0.9, 20.0, -1.2])
    np.testing.assert_allclose(arm.forward(motors), module.forward(motors), atol=1e-15)
    np.testing.assert_allclose(arm.solve(arm.forward(motors), seed=motors)[0], motors, atol=1e-9)


def test_a_table_takes_them_too(tmp_path: Path) -> None:
    table = tmp_path / "plane.toml"
    row = '[[joints]]\nname = "q{}"\ntype = "revolute"\nalpha = 0\na = {}\nd = 0\ntheta = 0\n'
    rows = "".join(row.format(k, a) for k, a in enumerate((0, 0.4, 0.3), start=1))
    table.write_text(f'name = "plane"\nconvention = "modified"\n{rows}')
    options = ["--couple", "q2=q2*1-q1*1", "--couple", "q3=q3*1-q2*1", "-o", str(tmp_path)]
    assert run(["from-dh", str(table), *options, *QUICK]) == 0
    module = PythonModule(tmp_path / "plane_ik.py").module
    pose = module.forward([0.3, 0.9, 0.5])
    angle = 0.3 + (0.9 - 0.3) + (0.5 - 0.9)
    np.testing.assert_allclose(pose[:2, 0], [np.cos(angle), np.sin(angle)], atol=1e-12)
    np.testing.assert_allclose(
        module.solve(pose, seed=[0.3, 0.9, 0.5])[0], [0.3, 0.9, 0.5], atol=1e-9
    )


@pytest.mark.long
@pytest.mark.skipif(importlib.util.find_spec("nanobind") is None, reason="needs nanobind")
@pytest.mark.skipif(not shutil.which("c++"), reason="needs a C++ compiler")
def test_a_compiled_arm_does_what_the_arm_does(
    scara: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("IKGEN_CACHE_DIR", str(tmp_path / "cache"))
    monkeypatch.setattr(cpp_toolchain, "FULL", LIGHT)
    relations = dict(text.partition("=")[::2] for text in OPTIONS[1::2])
    arm = ikgen.load(scara, couple=relations, verify=False)
    fast = ikgen.compile(arm)
    motors = np.array([0.4, 0.9, 20.0, -1.2])
    pose = arm.forward(motors)
    np.testing.assert_allclose(fast.forward(motors), pose, atol=1e-12)
    np.testing.assert_allclose(fast.jacobian(motors), arm.jacobian(motors), atol=1e-12)
    mine, theirs = fast.solve(pose, seed=motors), arm.solve(pose, seed=motors)
    np.testing.assert_allclose(mine.q, theirs.q, atol=1e-9)
    assert mine.branch == theirs.branch and len(mine) == 2
