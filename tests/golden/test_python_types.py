"""Emitted Python modules and packages hold strict type checking, so that packages that do can use them."""

from __future__ import annotations

import importlib.util
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from ikgen.emit import nanobind
from ikgen.emit.python.python_emitter import emit_module
from ikgen.derivation.derive import derive
from ikgen.records.request import Request

pytestmark = pytest.mark.usefixtures("solved_once")

ROOT = Path(__file__).resolve().parents[2]
ARMS = {
    "held": Request(ROOT / "urdf_fixtures/franka_fr3.urdf", free={"fr3_joint7": None}),
    "rounded": Request(ROOT / "urdf_fixtures/doosan_m1013.urdf"),
    "near": Request(ROOT / "urdf_fixtures/kuka_kr6r900sixx.urdf"),
    "eliminated": Request(ROOT / "tests/robots/tables/KawasakiRS05L.toml"),
}


@pytest.mark.skipif(importlib.util.find_spec("mypy") is None, reason="needs mypy")
def test_modules_and_packages_are_typed(tmp_path: Path, tmp_path_factory: pytest.TempPathFactory) -> None:
    near = tmp_path_factory.mktemp("robot") / "near.urdf"
    text = ARMS["near"].robot.read_text()
    near.write_text(text.replace("-1 0 0", "-1 0.00001 0", 1))
    for name, request in ARMS.items():
        robot = near if name == "near" else request.robot
        module = replace(derive(replace(request, robot=robot)).module, name=name)
        if name == "near":  # rows of no poses beside
            assert module.rounded and module.policy.beside_reach < module.policy.anywhere
        (tmp_path / f"{name}_ik.py").write_text(emit_module(module), encoding="utf-8")
        for path, text in nanobind.emit(module).items():
            if path.endswith((".py", ".pyi")):  # the package lies in a folder of its name
                file = tmp_path / path.partition("/")[2]
                file.parent.mkdir(exist_ok=True)
                file.write_text(text, encoding="utf-8")
    cache = ROOT / "build" / "mypy"  # NumPy is read once for all runs
    options = ["--strict", "--config-file=", f"--cache-dir={cache}"]
    command = [sys.executable, "-m", "mypy", *options, "."]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    assert f"in {3 * len(ARMS)} source files" in done.stdout
