"""Importers, emitters, leaves and tasks of other packages: found, used, and named when they fail."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest
from tests.support.small_robots import PLANAR
from tests.support.solving import NO_COMPILER

FIXTURES = Path(__file__).resolve().parents[2] / "urdf_fixtures"


def package(folder: Path, entry_points: dict[str, str], code: str = "") -> Path:
    """An installed package `other` 1.2: one entry point a group, `other.py` with the code."""
    info = folder / "other-1.2.dist-info"
    info.mkdir(parents=True)
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: other\nVersion: 1.2\n")
    lines = [f"[ikgen.{group}]\n{entry}\n" for group, entry in entry_points.items()]
    (info / "entry_points.txt").write_text("\n".join(lines))
    (folder / "other.py").write_text(textwrap.dedent(code))
    return folder


def ikgen(folder: Path, *arguments: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "ikgen", *map(str, arguments)],
        text=True,
        capture_output=True,
        env={**os.environ, "PYTHONPATH": str(folder)},
    )


def blamed(done: subprocess.CompletedProcess[str], *words: str) -> None:
    """The run ended with an error that names the package; never a traceback."""
    assert done.returncode == 2, done.stderr
    assert "Traceback" not in done.stderr and "internal error" not in done.stderr
    for word in ("other 1.2", *words):
        assert word in done.stderr


@pytest.fixture
def planar(tmp_path: Path) -> Path:
    robot = tmp_path / "planar.urdf"
    robot.write_text(PLANAR)
    return robot


BROKEN = {
    "importers": "sdf = other:NO_SUCH",
    "emitters": "fortran = other_fortran:EMITTER",
    "tasks": "planar = other:TASK",
}


def test_broken_ones_matter_only_to_who_uses_them(tmp_path: Path, planar: Path) -> None:
    site = package(tmp_path / "site", BROKEN, "TASK = 7")
    command = ("from-urdf", planar, "-o", tmp_path, "--task", "position", "--no-verify")
    assert ikgen(site, *command).returncode == 0
    blamed(ikgen(site, *command, "--emit", "fortran"), "emitter 'fortran'", "other_fortran:EMITTER")
    blamed(ikgen(site, *command, "--task", "planar"), "task 'planar'", "is of type int")
    (tmp_path / "robot.sdf").write_text("")
    blamed(ikgen(site, "inspect", tmp_path / "robot.sdf"), "importer 'sdf'", "NO_SUCH")


def test_doctor_lists_them_with_their_package(tmp_path: Path) -> None:
    site = package(tmp_path / "site", {**BROKEN, "leaves": "slide = other:SLIDE"}, LEAF)
    done = ikgen(site, "doctor", "--json")
    assert done.returncode == 1
    found = {row["kind"]: row for row in json.loads(done.stdout)["plug_ins"]}
    assert {row["package"] for row in found.values()} == {"other 1.2"}
    assert found["leaf"]["problem"] is None
    assert "No module named 'other_fortran'" in found["emitter"]["problem"]
    text = ikgen(site, "doctor").stdout
    assert "emitter 'fortran' of other 1.2 (other_fortran:EMITTER) cannot be loaded" in text


LEAF = """
from ikgen.solver.leaves import Leaf
def find(equations, unknown, knowledge):
    raise KeyError("on purpose")
SLIDE = Leaf("slide", find)
"""


def test_a_leaf_that_fails_is_named(tmp_path: Path, planar: Path) -> None:
    command = ("from-urdf", planar, "-o", tmp_path, "--task", "position", "--no-verify", "-q")
    working = package(tmp_path / "empty", {})
    assert ikgen(working, *command).returncode == 0
    site = package(tmp_path / "site", {"leaves": "slide = other:SLIDE"}, LEAF)
    blamed(ikgen(site, *command), "leaf 'slide'", "KeyError: 'on purpose'")
    assert ikgen(site, "verify", tmp_path, "--samples", 20).returncode == 0


EMITTER = """
from ikgen.generation.emitters import Emitter
LIST = Emitter("list", "joint names", "other:emit", None)
def emit(derivation):
    return {f"{derivation.module.name}.txt": "\\n".join(derivation.reading.no_such)}
"""


def test_an_emitter_that_fails_is_named_and_nothing_is_written(
    tmp_path: Path, planar: Path
) -> None:
    site = package(tmp_path / "site", {"emitters": "list = other:LIST"}, EMITTER)
    out = tmp_path / "out"
    done = ikgen(
        site, "from-urdf", planar, "-o", out, "--task", "position", "--emit", "python,list"
    )
    blamed(done, "emitter 'list'", "AttributeError")
    assert not list(out.glob("*"))


TASK = """
from ikgen.tasks import Task
PLANE = Task("plane", frozenset({"px", "py"}), 2, "position in the base's x-y plane")
"""


def test_a_task_is_solved_emitted_and_verified(tmp_path: Path, planar: Path) -> None:
    languages = "python" if NO_COMPILER else "python,cpp"
    site = package(tmp_path / "site", {"tasks": "plane = other:PLANE"}, TASK)
    done = ikgen(
        site, "from-urdf", planar, "-o", tmp_path, "--task", "plane", "--emit", languages,
        "--no-verify", "--json",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    record = json.loads(done.stdout)
    assert record["max_solutions"] == 2 and record["task"] == "plane"
    done = ikgen(site, "verify", tmp_path, "--samples", 60, "--json")
    (checked,) = json.loads(done.stdout)["outputs"]
    assert sorted(checked["verification"]) == sorted(languages.split(","))
    assert done.returncode == 0 and all(
        report["passed"] for report in checked["verification"].values()
    )


IMPORTER = """
from pathlib import Path
from ikgen.importers import Importer, load_tree
ROBOT = Importer("quoted", (".quoted",), "other")
def read(path, *, arguments, package_paths):
    plain = path.with_suffix(".urdf")
    plain.write_text(path.read_text().replace("{", "<").replace("}", ">"))
    return load_tree(plain, arguments=arguments, package_paths=package_paths)
"""


def test_an_importer_reads_its_suffix(tmp_path: Path, planar: Path) -> None:
    site = package(tmp_path / "site", {"importers": "quoted = other:ROBOT"}, IMPORTER)
    robot = tmp_path / "robot.quoted"
    robot.write_text(PLANAR.replace("<", "{").replace(">", "}"))
    done = ikgen(site, "inspect", robot, "--no-advice", "--json")
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["chain"]["joints"] == ["shoulder", "elbow"]
