"""`ikgen.load`: arms that solve, the cache, what is light, and wrong arguments one by one."""

from __future__ import annotations

import copy
import inspect
import pickle
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.support.sampled import sampled

import ikgen
from ikgen.errors import ArgumentError, IkgenError, UnknownNameError

pytestmark = pytest.mark.usefixtures("solved_once")

ROOT = Path(__file__).resolve().parents[2]
FIXTURES = ROOT / "urdf_fixtures"
ELBOW = ROOT / "examples/setuptools_robot/urdf/elbow.urdf"


@pytest.fixture(autouse=True)
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A cache of its own for every test."""
    monkeypatch.setenv("IKGEN_CACHE_DIR", str(tmp_path / "cache"))
    yield tmp_path / "cache"


@pytest.fixture(scope="module")
def ur5e() -> ikgen.Arm:
    """An arm with eight solutions, verified on few poses."""
    return ikgen.load(FIXTURES / "ur5e.urdf", samples=50, cache=False)


def test_an_arm_solves_what_its_forward_kinematics_gives(ur5e: ikgen.Arm) -> None:
    q = np.array([0.2, -0.9, 1.1, 0.3, 0.6, -0.4])
    pose = ur5e.forward(q)
    found = ur5e.solve(pose)
    assert found.status.name == "OK" and len(found) == ur5e.max_solutions == 8
    assert np.allclose(ur5e.forward(found.q), pose, atol=1e-9)
    assert np.abs(found.q - q).max(axis=1).min() < 1e-9
    assert np.allclose(ur5e.solve(pose, seed=q).q[0], q, atol=1e-9)
    rows, count, status = ur5e.solve_batch(np.stack([pose, pose + 5.0]))
    assert count.tolist() == [8, 0] and status.tolist() == ["OK", "INVALID"]
    assert np.allclose(rows[0, :8], found.q)
    assert ur5e.jacobian(q).shape == (6, 6)


def test_an_arm_can_be_copied_and_sent_to_other_processes(ur5e: ikgen.Arm) -> None:
    q = np.array([0.2, -0.9, 1.1, 0.3, 0.6, -0.4])
    pose = ur5e.forward(q)
    for other in (pickle.loads(pickle.dumps(ur5e)), copy.deepcopy(ur5e)):
        assert other.source == ur5e.source and other.module is not ur5e.module
        assert (other.solve(pose).q == ur5e.solve(pose).q).all()
        assert other.derivation.order == ur5e.derivation.order


def test_an_arm_tells_what_it_is(ur5e: ikgen.Arm) -> None:
    assert ur5e.dof == len(ur5e.joint_names) == 6 and ur5e.free_joints == ()
    assert (ur5e.base_link, ur5e.tip_link, ur5e.task) == ("base_link", "tool0", "pose")
    assert (ur5e.lower < ur5e.upper).all()
    ur5e.lower[:] = 0.0  # a copy
    assert ur5e.lower[0] < 0.0
    report = ur5e.verification
    assert report is not None and report.passed and report.samples == 50
    assert report.check("closure").count > 0
    assert "ur5e" in repr(ur5e) and "8 solutions" in repr(ur5e)
    card = ur5e._repr_html_()
    assert "<svg" in card and "elbow_joint" in card and "at most 8 solutions" in card


def test_the_derivation_is_there(ur5e: ikgen.Arm) -> None:
    derivation = ur5e.derivation
    assert derivation.geometry.name and len(derivation.dh.rows) == 6
    assert len(derivation.order) == len(derivation.graph.steps)
    assert derivation.trace and derivation.held == ""


def test_a_solver_comes_from_the_cache_and_is_the_same(cache: Path) -> None:
    first = ikgen.load(ELBOW, samples=50)
    (file,) = (cache / "solvers").glob("*.json")
    stamp = file.stat().st_mtime_ns
    stages: list[str] = []
    again = ikgen.load(ELBOW, samples=50, progress=lambda stage, detail: stages.append(stage))
    assert stages == [] and file.stat().st_mtime_ns == stamp
    assert again.source == first.source and again.verification == first.verification
    assert again._repr_html_() == first._repr_html_()
    assert again.derivation.order == first.derivation.order
    ikgen.load(ELBOW, samples=51)
    assert len(list((cache / "solvers").glob("*.json"))) == 2


def test_a_derivation_made_again_gives_the_same_module() -> None:
    ikgen.load(ELBOW, samples=50)
    arm = ikgen.load(ELBOW, samples=50)
    from ikgen.emit.python.python_emitter import emit_module

    assert emit_module(arm.derivation.whole.module) == arm.source


@pytest.mark.parametrize("damage", sampled(["", "{}", "[1]", '{"text": 1}'], ["", "{}", "[1]"]))
def test_a_broken_cache_is_none(cache: Path, damage: str) -> None:
    text = ikgen.load(ELBOW, samples=50).source
    (file,) = (cache / "solvers").glob("*.json")
    file.write_text(damage)
    assert ikgen.load(ELBOW, samples=50).source == text
    assert file.read_text() != damage


def test_a_changed_cache_is_not_run(cache: Path) -> None:
    ikgen.load(ELBOW, samples=50)
    (file,) = (cache / "solvers").glob("*.json")
    file.write_text(file.read_text().replace("def forward", "raise SystemExit\\ndef forward", 1))
    assert ikgen.load(ELBOW, samples=50).dof > 0


def test_a_cache_that_cannot_be_written_is_no_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("IKGEN_CACHE_DIR", str(tmp_path / "file"))
    assert ikgen.load(ELBOW, samples=50).dof > 0


def test_files_are_those_of_the_command_line(tmp_path: Path, ur5e: ikgen.Arm) -> None:
    files = ur5e.save(tmp_path / "out")
    assert [file.name for file in files] == ["ur5e_ik.py", "ur5e_ik.json"]
    assert files[0].read_text() == ur5e.source
    page = ur5e.report(tmp_path / "arm.html")
    assert page == tmp_path / "arm.html" and "<math" in page.read_text()
    assert ur5e.report(tmp_path / "graph.svg").read_text().startswith("<svg")


def test_a_graph_that_there_is_none_of_is_refused(
    tmp_path: Path, ur5e: ikgen.Arm, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("ikgen.report.emit_report", lambda *_: {"arm_report.html": "<html>"})
    with pytest.raises(ikgen.errors.ArgumentError, match="none of this arm is solved alone"):
        ur5e.report(tmp_path / "graph.svg")


WRONG: dict[str, tuple[Any, str]] = {
    "robot": (3.5, "robot"),
    "base": (7, "base"),
    "tip": ("", "tip"),
    "task": ("fly", "task"),
    "tool_axis": ("w", "task"),
    "free": (3, "free"),
    "lock": (["elbow"], "lock"),
    "couple": ("elbow=shoulder", "couple"),
    "args": ("a:=b", "args"),
    "calibration": ("nowhere.yaml", "calibration"),
    "verify": ("yes", "verify"),
    "samples": (0, "samples"),
    "package_paths": (["nowhere"], "package_paths"),
    "name": ("a-b", "name"),
    "trust": (1, "trust"),
    "cache": (None, "cache"),
    "progress": (None, "progress"),
}


class Unspeakable:
    """What cannot even be shown."""

    def __repr__(self) -> str:
        raise RuntimeError


def test_every_argument_is_tried() -> None:
    assert set(WRONG) == set(inspect.signature(ikgen.load).parameters)


@pytest.mark.parametrize("value", [Unspeakable(), object(), 1j], ids=["odd", "object", "complex"])
@pytest.mark.parametrize("argument", WRONG)
def test_what_is_of_no_use_is_refused(argument: str, value: object) -> None:
    with pytest.raises(ArgumentError, match=argument) as caught:
        ikgen.load(**{"robot": ELBOW, "verify": False, argument: value})
    assert caught.value.hint


@pytest.mark.parametrize("argument", WRONG)
def test_every_wrong_argument_is_named(argument: str) -> None:
    value, named = WRONG[argument]
    with pytest.raises(ArgumentError) as caught:
        ikgen.load(**{"robot": ELBOW, argument: value})
    error = caught.value
    assert isinstance(error, IkgenError) and isinstance(error, ValueError)
    assert error.message.startswith(named) and error.hint and error.hint in str(error)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"robot": "nowhere.urdf"}, "no file"),
        ({"robot": FIXTURES}, "directory"),
        ({"robot": ""}, "empty"),
        ({"robot": FIXTURES / "puma560_paper.toml", "base": "world"}, "base"),
        ({"lock": {"elbow": "much"}}, "lock"),
        ({"lock": {"elbow": float("nan")}}, "lock"),
        ({"free": {"elbow": "45 apples"}}, "free"),
        ({"free": "elbow", "lock": {"elbow": 0.0}}, "both"),
        ({"args": {"a": "b"}}, "no arguments"),
        ({"robot": "x" * 5000}, "no file"),
        ({"robot": "a\0b"}, "no file"),
        ({"calibration": "x" * 5000}, "no file"),
        ({"package_paths": "x" * 5000}, "no file"),
        ({"package_paths": ""}, "package_paths"),
        ({"package_paths": [ELBOW]}, "no directory"),
        ({"samples": 10**400}, "samples"),
        ({"samples": np.array([1.0])}, "samples"),
        ({"lock": {"elbow": 10**400}}, "finite"),
        ({"couple": {"elbow": Unspeakable()}}, "couple: elbow"),
        ({"couple": {"elbow": "shoulder + shoulder"}}, "no joint named"),
        ({"couple": {"nowhere": "elbow*1+0"}}, "nowhere"),
        ({"couple": {"elbow": "nowhere*1+0"}}, "nowhere"),
        ({"couple": {"elbow": "elbow*1+0"}}, "elbow"),
        ({"lock": {"elbow": "45mm"}}, "'mm' is no unit of a joint that turns"),
        ({"free": {"elbow": "0.1m"}}, "'m' is no unit of a joint that turns"),
        ({"name": "x" * 101}, "100 characters"),
    ],
)
def test_arguments_that_do_not_fit(options: dict[str, Any], message: str) -> None:
    with pytest.raises(IkgenError, match=message) as caught:
        ikgen.load(**{"robot": ELBOW, **options})
    assert caught.value.hint


def test_a_unit_that_does_not_fit_is_refused_with_a_cache_too() -> None:
    ikgen.load(ELBOW, lock={"elbow": "0.045rad"}, verify=False)
    ikgen.load(ELBOW, lock={"elbow": 0.045}, verify=False)
    with pytest.raises(IkgenError, match="no unit"):
        ikgen.load(ELBOW, lock={"elbow": "45mm"}, verify=False)


def test_units_of_slides_and_tables() -> None:
    scara = FIXTURES / "scara_standard.toml"
    joints = ikgen.load(scara, verify=False).derivation.dh.joints
    slide = next(joint.name for joint in joints if joint.kind == "prismatic")
    assert ikgen.load(scara, lock={slide: "120mm"}, verify=False).dof == 3
    with pytest.raises(IkgenError, match="slides"):
        ikgen.load(scara, lock={slide: "5deg"}, verify=False)


@pytest.mark.parametrize("option", ["base", "tip"])
def test_a_link_that_there_is_not_is_told_with_those_there_are(option: str) -> None:
    with pytest.raises(UnknownNameError) as caught:
        ikgen.load(ELBOW, **{option: "nowhere"})
    assert "there is" in caught.value.hint


@pytest.mark.parametrize(
    "call",
    [
        lambda arm: arm.solve(np.eye(2)),
        lambda arm: arm.solve("here"),
        lambda arm: arm.solve(np.eye(4), seed=[0.0]),
        lambda arm: arm.solve(np.eye(4), free={"elbow_joint": 0.0}),
        lambda arm: arm.solve_batch(np.eye(4)),
        lambda arm: arm.forward([1.0]),
        lambda arm: arm.jacobian("q"),
        lambda arm: arm.save(3),
        lambda arm: arm.save("out", emit=[]),
        lambda arm: arm.save("out", emit="cobol"),
        lambda arm: arm.report("arm.docx"),
        lambda arm: arm.report(None),
        lambda arm: arm.save("a\0b"),
        lambda arm: arm.save("x" * 5000),
        lambda arm: arm.save("/proc/none/out"),
        lambda arm: arm.report("x" * 5000 + ".html"),
        lambda arm: arm.report("/proc/none/arm.html"),
        lambda arm: arm.report("\ud800.html"),
        lambda arm: arm.save(Unspeakable()),
        lambda arm: arm.save("out", emit=Unspeakable()),
        lambda arm: arm.self_motion(np.eye(4)),
        lambda arm: ikgen.compile(Unspeakable()),
    ],
)
def test_wrong_arguments_of_an_arm_are_ikgens_errors(ur5e: ikgen.Arm, call: Any) -> None:
    with pytest.raises(IkgenError) as caught:
        call(ur5e)
    assert caught.value.hint


NUMBERS = ("x", b"x", {1: 2}, set(), 10**400, [1j] * 6, [[1], [2, 3]], [{}] * 6, Unspeakable())
FLAGS = ("no", 1, None, np.eye(2), Unspeakable())


@pytest.mark.parametrize("value", NUMBERS, ids=lambda value: type(value).__name__)
@pytest.mark.parametrize(
    ("argument", "call"),
    [
        ("pose", lambda arm, T, x: arm.solve(x)),
        ("pose", lambda arm, T, x: arm.solve(x, project=True, orthonormalize=True)),
        ("pose", lambda arm, T, x: arm.solve_batch(x)),
        ("pose", lambda arm, T, x: arm.follow(x, start=[0.0] * arm.dof)),
        ("seed", lambda arm, T, x: arm.solve(T, seed=x)),
        ("seed", lambda arm, T, x: arm.solve_batch(T[None], seed=x)),
        ("free", lambda arm, T, x: arm.solve(T, free=x)),
        ("free", lambda arm, T, x: arm.solve_batch(T[None], free=x)),
        ("start", lambda arm, T, x: arm.follow(T[None], start=x)),
        ("q", lambda arm, T, x: arm.forward(x)),
        ("q", lambda arm, T, x: arm.jacobian(x)),
    ],
)
def test_what_is_no_array_of_numbers_is_told_by_its_name(
    ur5e: ikgen.Arm, argument: str, call: Any, value: object
) -> None:
    with pytest.raises(ArgumentError, match=f": .*{argument}") as caught:
        call(ur5e, np.eye(4), value)
    assert caught.value.hint and "help()" not in caught.value.hint


@pytest.mark.parametrize("value", FLAGS, ids=lambda value: type(value).__name__)
@pytest.mark.parametrize("flag", ["limits", "project", "orthonormalize"])
def test_flags_are_true_or_false(ur5e: ikgen.Arm, flag: str, value: object) -> None:
    with pytest.raises(ArgumentError, match=f"^{flag}") as caught:
        ur5e.solve(np.eye(4), **{flag: value})
    assert "True or False" in caught.value.hint
    ur5e.solve(np.eye(4), **{flag: np.bool_(True)})


def test_the_package_is_light() -> None:
    code = "import sys, ikgen; print(*(m for m in sys.modules if m.split('.')[0] in {'ikgen', 'numpy'}))"
    done = subprocess.run([sys.executable, "-c", code], text=True, capture_output=True, check=True)
    assert done.stdout.split() == ["ikgen"]
    assert {"load", "Arm", "IkgenError"} <= set(dir(ikgen))
    with pytest.raises(AttributeError):
        ikgen.unload  # noqa: B018
