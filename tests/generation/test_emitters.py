"""Which file of an output has the solver; what another package's emitter does not write is refused."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from importlib.metadata import EntryPoint
from pathlib import Path

import pytest
from tests.support.redundant_arms import SHOULDER_ELBOW_WRIST, serial_urdf
from tests.support.small_robots import write_robot
from tests.support.solving import FIXTURES

from ikgen.derivation.derive import derive
from ikgen.emit.derivation import Derivation
from ikgen.errors import UsageError
from ikgen.generation.emitters import EMITTERS, Emitter
from ikgen.plugins import PlugIn
from ikgen.records.request import Request

pytestmark = pytest.mark.usefixtures("solved_once")

ENTRY = EntryPoint("ada", "ada:ADA", "ikgen.emitters")
ADA = Emitter(
    "ada",
    "a package of Ada",
    f"{__name__}:written",
    plug_in=PlugIn(ENTRY.group, ENTRY.name, ENTRY.value, "ada 1.0", ENTRY),
)


def written(derivation: Derivation) -> dict[str, str]:
    return {"arm.ads": derivation.module.name}


def geared(folder: Path) -> Request:
    couple = {"elbow": "elbow*1+shoulder*0.5"}
    return Request(write_robot(folder / "geared.urdf"), task="position", couple=couple)


def symbolic(folder: Path) -> Request:
    return Request(FIXTURES / "puma560_symbolic.toml")


def redundant(folder: Path) -> Request:
    path = folder / "redundant.urdf"
    path.write_text(serial_urdf("redundant", SHOULDER_ELBOW_WRIST))
    return Request(path, free={"arm-angle": None})


@pytest.mark.parametrize(
    ("made", "name", "words"),
    [
        (geared, "motors", "motors that move several joints"),
        (symbolic, "blanks", "constants to be filled in"),
        (redundant, "arm-angle", "the arm angle"),
    ],
)
def test_an_arm_that_needs_more_is_refused(
    made: Callable[[Path], Request], name: str, words: str, tmp_path: Path
) -> None:
    derivation = derive(made(tmp_path))
    assert list(derivation.module.beyond) == [name]
    with pytest.raises(UsageError, match=f"emitter 'ada' of .* does not write {words}"):
        ADA.emit(derivation)
    assert replace(ADA, beyond=(name,)).emit(derivation)
    assert replace(ADA, plug_in=None).emit(derivation)


def test_others_are_written(tmp_path: Path) -> None:
    derivation = derive(Request(write_robot(tmp_path / "elbow.urdf"), task="position"))
    assert not derivation.module.beyond and ADA.emit(derivation)


def test_each_output_knows_the_file_with_its_solver(tmp_path: Path) -> None:
    derivation = derive(
        Request(write_robot(tmp_path / "elbow.urdf"), task="position", name="Elbow")
    )
    texts = {row.name: row.emit(derivation) for row in EMITTERS if row.runner_target is not None}
    every = [file for files in texts.values() for file in files]
    found = {row.name: row.main_among(every, "Elbow") for row in EMITTERS if row.name in texts}
    assert found == {
        "python": "Elbow_ik.py",
        "cpp": "Elbow_ik.hpp",
        "cpp-package": "Elbow_ik_cpp/include/Elbow_ik.hpp",
        "nanobind": "Elbow_ik_ext/Elbow_ik.hpp",
        "moveit": "elbow_ik_moveit/include/elbow_ik_moveit/Elbow_ik.hpp",
    }
    assert all(found[name] in files for name, files in texts.items())
    assert EMITTERS[0].main_among(every, "other") is None and ADA.main_among(every, "Elbow") is None
