"""The example of an output language as a package: installed, used, compiled and compared."""

from __future__ import annotations

import importlib
import re
import shutil
import subprocess
import sys
import zipfile
from ast import literal_eval
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from tests.support.sampled import sampled

from ikgen.errors import UsageError
from ikgen.generation.emitted_arm import EmittedArm
from ikgen.generation.emitters import find_emitter
from ikgen.generation.generate import generate
from ikgen.program.policy import SolvePolicy
from ikgen.records.request import Outputs, Request
from ikgen.verify.runners.python_module import PythonModule

pytest.importorskip("hatchling")
pytestmark = [
    pytest.mark.usefixtures("solved_once"),
    pytest.mark.skipif(shutil.which("rustc") is None, reason="rustc is not installed"),
]

ROOT = Path(__file__).resolve().parents[2]
FIXTURES = ROOT / "urdf_fixtures"
ARMS = {
    "kuka_kr6r900sixx": Request(FIXTURES / "kuka_kr6r900sixx.urdf"),
    "a joint held": Request(FIXTURES / "franka_fr3.urdf", free={"fr3_joint7": 0.3}),
    "a smaller task": Request(FIXTURES / "open_manipulator_x.urdf"),
    "rounded geometry": Request(FIXTURES / "ur5e.urdf"),
}


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """The package as pip installs it, in a folder of the path."""
    folder = tmp_path_factory.mktemp("plugin")
    project = shutil.copytree(ROOT / "examples/plugin_rust", folder / "project")
    command = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)]
    subprocess.run(command, cwd=project, check=True, capture_output=True)
    site = folder / "site"
    with zipfile.ZipFile(next(folder.glob("*.whl"))) as wheel:
        wheel.extractall(site)
    sys.path.insert(0, str(site))
    importlib.invalidate_caches()
    yield site
    sys.path.remove(str(site))


@pytest.mark.parametrize("arm", sampled(ARMS, ["a joint held", "rounded geometry"]))
def test_rows_are_those_of_the_python_module(arm: str, installed: Path, tmp_path: Path) -> None:
    made = generate(ARMS[arm], Outputs(("python", "rust"), tmp_path, verify=False))
    module = made.derivation.module
    python = PythonModule(tmp_path / f"{module.name}_ik.py")
    rust = find_emitter("rust").runner(EmittedArm.of(module), tmp_path)
    rng = np.random.default_rng(1)
    q = rng.uniform(-2.0, 2.0, (60, python.constants.dof))
    q[40:50, rng.integers(python.constants.dof)] = 0.0  # many arms are singular there
    poses = python.forward(q)
    poses[50:, :3, 3] *= 1.5  # some of them out of reach
    seeds = q + rng.uniform(0.01, 0.05, q.shape)  # no joint exactly half a turn from its seed
    for limits in (True, False):
        ours = python.solve_many(poses, seeds=seeds, limits=limits)
        theirs = rust.solve_many(poses, seeds=seeds, limits=limits)
        assert theirs.status == ours.status
        np.testing.assert_array_equal(theirs.count, ours.count)
        rows = zip(ours, theirs, ours.singular, theirs.singular, strict=True)
        for mine, other, flags, other_flags in rows:
            # of a row on a continuum it is a matter of the last bits where it lies there
            regular = ~flags[: len(mine)]
            np.testing.assert_array_equal(other_flags[: len(mine)], flags[: len(mine)])
            np.testing.assert_allclose(other[regular], mine[regular], rtol=0, atol=1e-7)
    np.testing.assert_allclose(rust.forward(q), python.forward(q), rtol=0, atol=1e-12)
    np.testing.assert_allclose(rust.jacobian(q), python.jacobian(q), rtol=0, atol=1e-12)


def test_the_policy_is_the_one_that_all_languages_share(installed: Path, tmp_path: Path) -> None:
    made = generate(ARMS["rounded geometry"], Outputs(("rust",), tmp_path, verify=False))
    policy = made.derivation.module.policy
    text = (tmp_path / "ur5e_ik_rs/src/arm.rs").read_text()
    values = dict(re.findall(r"const (\w+): (?:f64|usize) = ([-+.e\d]+);", text))
    names = [name for name in SolvePolicy.__dataclass_fields__ if name.upper() in values]
    assert len(names) == 15
    for name in names:
        assert float(values[name.upper()]) == getattr(policy, name), name
    (stages,) = re.findall(r"const REFINEMENT: [^=]*= \[\n(.*?)\];", text, re.DOTALL)
    expected = [(one.steps, one.fine, one.promising) for one in policy.refinement]
    assert list(literal_eval(f"[{stages}]")) == expected
    for name in ("newton.rs", "rows.rs"):
        fixed = (tmp_path / "ur5e_ik_rs/src" / name).read_text()
        assert set(re.findall(r"\b\d+e-\d+|\b0\.0*[1-9]\d*", fixed)) <= {"1e-300", "1e-30"}


def test_the_crate_compiles_without_warnings_and_is_verified(
    installed: Path, tmp_path: Path
) -> None:
    made = generate(ARMS["kuka_kr6r900sixx"], Outputs(("rust",), tmp_path, samples=100))
    assert made.reports["rust"].passed
    library = tmp_path / "kuka_kr6r900sixx_ik_rs/src/lib.rs"
    command = ["rustc", "--edition=2021", "--crate-type=lib", "--emit=metadata", "-Dwarnings"]
    done = subprocess.run(
        [*command, "-o", str(tmp_path / "arm.rmeta"), str(library)], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize(
    ("table", "routine"), [("ArmRobo", "trig_quartic"), ("KawasakiRS05L", "general_6r")]
)
def test_an_arm_that_needs_a_routine_is_refused(
    table: str, routine: str, installed: Path, tmp_path: Path
) -> None:
    request = Request(ROOT / f"tests/robots/tables/{table}.toml")
    with pytest.raises(UsageError, match=f"no routine '{routine}'"):
        generate(request, Outputs(("rust",), tmp_path))
    assert not list(tmp_path.iterdir())
