"""The module of SymPy expressions runs by itself and gives the emitted module's rows."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from tests.support.sampled import sampled
from tests.support.solving import FIXTURES, import_text

from ikgen.cli.main import run
from ikgen.derivation.derive import derive
from ikgen.emit.python.python_emitter import emit_module
from ikgen.errors import UsageError
from ikgen.records.request import Request
from ikgen.symbolic.sympy_module import module_text

pytestmark = pytest.mark.usefixtures("solved_once")

TABLES = Path(__file__).resolve().parents[1] / "robots" / "tables"
DRIVER = """
import json, sys
sys.path.insert(0, sys.argv[1])
module = __import__(sys.argv[2])
assert "ikgen" not in sys.modules
print(json.dumps([module.solve(pose) for pose in json.load(open(sys.argv[3]))]))
"""


ROBOTS = {
    "puma560_paper": FIXTURES / "puma560_paper.toml",
    "scara_standard": FIXTURES / "scara_standard.toml",
    "ArmRobo": TABLES / "ArmRobo.toml",
    "Stanford": TABLES / "Stanford.toml",
    "kuka_kr6r900sixx": FIXTURES / "kuka_kr6r900sixx.urdf",
}


@pytest.mark.parametrize("robot", sampled(ROBOTS, ["scara_standard"]))
def test_module_solves_by_itself(robot: str, tmp_path: Path) -> None:
    derivation = derive(Request(ROBOTS[robot]))
    (tmp_path / "arm_sympy.py").write_text(module_text(derivation))
    module = import_text(emit_module(derivation.module), tmp_path)
    q = np.random.default_rng(3).uniform(-1.4, 1.4, (3, module.DOF))
    poses = module.forward(q)
    (tmp_path / "poses.json").write_text(json.dumps(poses.tolist()))
    command = [
        sys.executable,
        "-c",
        DRIVER,
        str(tmp_path),
        "arm_sympy",
        str(tmp_path / "poses.json"),
    ]
    done = subprocess.run(command, text=True, capture_output=True)
    assert done.returncode == 0, done.stderr
    for pose, found in zip(poses, json.loads(done.stdout), strict=True):
        rows = np.array([[row[name] for name in module.JOINT_NAMES] for row in found])
        emitted = module.solve(pose, limits=False).q
        assert len(rows) == len(emitted) > 0
        turned = np.abs(np.sin((rows[:, None] - emitted[None]) / 2)).max(axis=-1)
        assert turned.min(axis=1).max() < 1e-6 and turned.min(axis=0).max() < 1e-6


def test_report_writes_it(tmp_path: Path) -> None:
    table = str(FIXTURES / "scara_standard.toml")
    assert run(["report", table, "-o", str(tmp_path), "--emit", "sympy", "--no-verify", "-q"]) == 0
    (made,) = tmp_path.glob("*_sympy.py")
    assert "SOLUTIONS" in made.read_text() and list(tmp_path.glob("*_report.html"))


def test_what_the_elimination_solves_has_no_formulas() -> None:
    derivation = derive(Request(TABLES / "KawasakiRS05L.toml"))
    with pytest.raises(UsageError, match="no formulas"):
        module_text(derivation)
