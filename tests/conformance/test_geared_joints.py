"""Arms with joints that follow others by gears: every solution, of whole ratios and others."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.support.redundant_arms import serial_urdf
from tests.support.sampled import in_languages
from tests.support.solving import import_text

from ikgen.derivation.derive import derive
from ikgen.emit.python.python_emitter import emit_module
from ikgen.generation.generate import generate
from ikgen.records.request import Outputs, Request

pytestmark = pytest.mark.usefixtures("solved_once")

FINGER = (
    ("spread", "revolute", "1 0 0", "0.02 0 0.09", (-0.3, 0.3)),
    ("near", "revolute", "0 1 0", "0 0 0", (-0.2, 1.6)),
    ("middle", "revolute", "0 1 0", "0 0 0.045", (-2.9, 2.9)),
    ("end", "revolute", "0 1 0", "0 0 0.025", (0.0, 1.7)),
)
WRIST = (
    ("yaw", "revolute", "0 0 1", "0 0 0.3", (-3.0, 3.0)),
    ("shoulder", "revolute", "0 1 0", "0.05 0 0.1", (-1.2, 1.2)),
    ("elbow", "revolute", "0 1 0", "0 0 0.3", (-2.6, 2.6)),
    ("pitch", "revolute", "0 1 0", "0 0 0.25", (-2.4, 2.4)),
    ("roll", "revolute", "1 0 0", "0.1 0 0.05", (-2.8, 2.8)),
    ("bend", "revolute", "0 1 0", "0.2 0 0", (-2.0, 2.0)),
    ("spin", "revolute", "1 0 0", "0.1 0 0", (-2.8, 2.8)),
)
AROUND = tuple((*j[:4], (-3.3, 3.3) if j[0] == "shoulder" else j[4]) for j in WRIST)
TURRET = (WRIST[0], ("again", "revolute", "0 0 1", "0 0 0.1", (-3.0, 3.0)), *WRIST[1:5], WRIST[6])
ARMS = {
    "finger": (FINGER, "end", "middle", "0.8"),
    "decimal finger": (FINGER, "end", "middle", "1.1393"),
    "elbow": (WRIST, "elbow", "shoulder", "2"),
    "elbow of a shoulder that goes around": (AROUND, "elbow", "shoulder", "2"),
    "slow elbow": (WRIST, "elbow", "shoulder", "-0.7"),
    "differential": (WRIST, "bend", "roll", "0.5"),
    "turret that turns again by half": (TURRET, "again", "yaw", "0.5"),
}
RARE = ("turret that turns again by half", "elbow of a shoulder that goes around", "differential")


def geared(kind: str, folder: Path) -> Path:
    """URDF of one of the arms."""
    links, follower, source, ratio = ARMS[kind]
    joint = f'<joint name="{follower}" type="revolute">'
    mimic = f'{joint}<mimic joint="{source}" multiplier="{ratio}" offset="0.1"/>'
    path = folder / "arm.urdf"
    path.write_text(serial_urdf("arm", links).replace(joint, mimic))
    return path


@pytest.mark.parametrize(("kind", "language"), in_languages(ARMS, (), RARE))
def test_geared_arms_are_verified(kind: str, language: str, tmp_path: Path) -> None:
    outputs = Outputs((language,), tmp_path / "out", samples=300)
    (report,) = generate(Request(geared(kind, tmp_path)), outputs).reports.values()
    assert report.passed and report.missed == 0
    whole = ARMS[kind][3].lstrip("-").isdigit()
    said = f"values of {ARMS[kind][2]} inside the limits"
    assert (said in report.check("exhaustive search").detail) != whole


@pytest.mark.parametrize("kind", ["finger", "decimal finger"])
def test_every_value_of_a_geared_joint_is_found(kind: str, tmp_path: Path) -> None:
    """As many as the tip's distance from the base of the finger has crossings on a fine grid."""
    path = geared(kind, tmp_path)
    arm = import_text(emit_module(derive(Request(path)).module), tmp_path)
    ratio = float(ARMS[kind][3])
    middle = np.linspace(arm.LOWER[2], arm.UPPER[2], 20_001)

    def reach(u: np.ndarray) -> np.ndarray:
        bones = 0.045 + 0.025 * np.exp(1j * u) + 0.1 * np.exp(1j * (u + ratio * u + 0.1))
        return np.asarray(np.abs(bones))

    rng, several = np.random.default_rng(2), 0
    for _ in range(100):
        q = rng.uniform(arm.LOWER, arm.UPPER)
        rows = arm.solve(arm.forward(q), limits=False).q
        inside = rows[(rows[:, 2] >= arm.LOWER[2]) & (rows[:, 2] <= arm.UPPER[2])]
        values = np.unique(np.round(inside[:, 2], 7))
        crossings = np.diff(reach(middle) > reach(q[2])) != 0
        assert len(values) == crossings.sum() and np.abs(values - q[2]).min() < 1e-6
        several += len(values) > 1
    assert several > 10
