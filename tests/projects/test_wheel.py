"""A wheel carries the templates; wheel, sdist and editable install pass the same smoke test."""

from __future__ import annotations

import shutil
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest
from tests.support.environments import Environment, without_ikgen
from tests.support.sampled import sampled
from tests.support.snippets import blocks

pytest.importorskip("hatchling")
ROOT = Path(__file__).resolve().parents[2]
KINDS = ("wheel", "sdist", "editable")


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The wheel and the sdist of this checkout."""
    out = tmp_path_factory.mktemp("prismatic")
    done = subprocess.run(
        [sys.executable, "-m", "hatchling", "build", "-d", str(out)],
        cwd=ROOT,
        text=True,
        capture_output=True,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return {"wheel": next(out.glob("*.whl")), "sdist": next(out.glob("*.tar.gz"))}


def test_everything_is_in_the_wheel(built: dict[str, Path]) -> None:
    with zipfile.ZipFile(built["wheel"]) as archive:
        names = archive.namelist()
    for part in (
        "ikgen/py.typed",
        "ikgen/templates/python/module.py.jinja",
        "ikgen/templates/cpp/header.hpp.jinja",
        "ikgen/runtime/cpp/arrays/lanes.hpp",
        "ikgen/templates/cmake/ikgenConfig.cmake",
        "ikgen/templates/ament/ikgen_ament/package.xml",
        "ikgen/projects/cmake_root/cmake/ikgenConfig.cmake",
    ):
        assert part in names, part
    assert any(n.endswith(".data/data/share/cmake/ikgen/ikgenConfig.cmake") for n in names)


def test_what_the_tests_need_is_in_the_sdist(built: dict[str, Path]) -> None:
    with tarfile.open(built["sdist"]) as archive:
        names = {name.split("/", 1)[1] for name in archive.getnames() if "/" in name}
    for part in ("action.yml", "examples/ament_description/ikgen.toml", "tests/conftest.py"):
        assert part in names, part
    assert not any(name.endswith("_ik.py") and "examples" in name for name in names)


@pytest.fixture(scope="module")
def installed(
    request: pytest.FixtureRequest, built: dict[str, Path], tmp_path_factory: pytest.TempPathFactory
) -> Environment:
    """An environment with ikgen installed one way, and what it depends on."""
    environment = without_ikgen(tmp_path_factory.mktemp(request.param) / "env")
    what = ("-e", ROOT) if request.param == "editable" else (built[request.param],)
    environment.install(*what)
    return environment


@pytest.mark.parametrize("installed", sampled(KINDS, ["wheel"]), indirect=True)
def test_the_page_on_the_library_works(installed: Environment, tmp_path: Path) -> None:
    """Its snippets, one after the other, in one program beside a robot.urdf."""
    shown = [block.text for block in blocks(ROOT / "docs/reference/library.md")]
    # all but what has to be compiled
    code = [text for text in shown if text.startswith(("import", "rough", "try"))]
    assert len(code) == 3
    robot = (ROOT / "urdf_fixtures/ur5e.urdf").read_text(encoding="utf-8")
    (tmp_path / "robot.urdf").write_text(robot, encoding="utf-8")
    script = "import os\nos.environ['IKGEN_CACHE_DIR'] = 'cache'\n" + "\n".join(code)
    (tmp_path / "page.py").write_text(script, encoding="utf-8")
    printed = installed.call("python", "page.py", cwd=tmp_path)
    assert "shoulder right, elbow up, wrist not flipped" in printed
    assert "lock: elbow_joint: 'much' is not a finite number" in printed
    assert (tmp_path / "generated/ur5e_ik.py").is_file()
    assert (tmp_path / "robot.html").is_file()


HELD = """
import os; os.environ["IKGEN_CACHE_DIR"] = "cache"
import ikgen
import numpy as np
import sympy

arm = ikgen.load("robot.urdf")
q = np.array([0.3, 0.4, -0.2, -1.6, 0.1, 2.0, 0.5])
T = arm.forward(q)

found = arm.solve(T, seed=q)
assert np.allclose(found[0], q) and len(found.branch) == len(found) == len(found[:])
rows, count, status = arm.solve_batch(np.stack([T, T]), seed=q)
assert count.tolist() == [len(found)] * 2 and status.tolist() == ["OK", "OK"]
assert arm.jacobian(q).shape == (6, 7)
path = arm.follow(np.stack([T, arm.forward(q + 0.01)]), start=q)
assert path.reached == 2
held = q[arm.joint_names.index(arm.free_joints[0])]
assert any(one.low <= held <= one.high for one in arm.self_motion(T))

derivation = arm.derivation
assert derivation.geometry.words and len(derivation.dh.rows) == 7
assert len(derivation.order) == 6 and derivation.trace
for variable, branches in derivation.solutions.items():
    for branch in branches:
        assert isinstance(branch.expression, sympy.Expr) and isinstance(branch.conditions, tuple)
assert all(isinstance(equation, sympy.Eq) for equation in derivation.equations)
assert derivation.equations
assert arm.verification.passed and len(arm.verification.table()) > 5

print(*(path.name for path in arm.save("out", emit=["python", "cpp"])))
print(arm.report("arm.html"))
card = arm._repr_html_()
assert "<svg" in card and "<table" in card and "at most 8 solutions" in card
"""


@pytest.mark.long
@pytest.mark.skipif(not shutil.which("c++"), reason="needs a C++ compiler")
@pytest.mark.parametrize("installed", ["wheel"], indirect=True)
def test_all_of_the_library_works_from_a_wheel(installed: Environment, tmp_path: Path) -> None:
    shutil.copy(ROOT / "urdf_fixtures/franka_fr3.urdf", tmp_path / "robot.urdf")
    (tmp_path / "use.py").write_text(HELD, encoding="utf-8")
    printed = installed.call("python", "use.py", cwd=tmp_path).split()
    assert printed[-1] == "arm.html" and (tmp_path / "arm.html").is_file()
    assert {"fr3_ik.py", "fr3_ik.hpp"} <= set(printed)


@pytest.mark.parametrize("installed", sampled(KINDS, ["sdist"]), indirect=True)
def test_smoke(installed: Environment, tmp_path: Path, request: pytest.FixtureRequest) -> None:
    kind = request.node.callspec.params["installed"]
    robot = ROOT / "examples/setuptools_robot/urdf/elbow.urdf"
    ikgen = installed.folder / "bin/ikgen"
    assert ikgen.is_file()
    code = "import ikgen; print(ikgen.__file__)"
    found = Path(installed.call("python", "-c", code, cwd=tmp_path).strip())
    assert found.is_relative_to(ROOT / "src" if kind == "editable" else installed.folder)
    for option, file in (((), "ikgenConfig.cmake"), (("--ament",), "package.xml")):
        printed = installed.call("ikgen", "cmake-dir", *option, cwd=tmp_path)
        assert (Path(printed.strip()) / file).is_file()
    assert (installed.folder / "share/cmake/ikgen/ikgenConfig.cmake").is_file()
    installed.call(
        "ikgen", "from-urdf", robot, "--task", "position", "--samples", 50, "-q",
        "-o", "out", cwd=tmp_path,
    )  # fmt: skip
    assert "right" in installed.call("ikgen", "verify", "out", "--samples", 50, cwd=tmp_path)
    installed.call(
        "ikgen", "from-urdf", robot, "--task", "position", "--no-verify", "-q", "--emit", "cpp",
        "-o", "header", cwd=tmp_path,
    )  # fmt: skip
    assert (tmp_path / "header/elbow_ik.hpp").is_file()
    use = "import elbow_ik as a; print(len(a.solve(a.forward([0.1, 0.4, 0.5]))))"
    assert int(installed.call("python", "-c", use, cwd=tmp_path / "out")) >= 1
