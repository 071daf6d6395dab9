"""A five-joint arm as files write it, with rounded right angles: where all its branches meet, poses hardly
change over a tenth of a turn and more."""

from __future__ import annotations

from pathlib import Path

from tests.support.serial_urdf import serial_urdf

from ikgen.importers.urdf.urdf_tree import parse_urdf
from ikgen.tasks import find_task
from ikgen.verify.arm import ArmUnderTest, arm_under_test
from ikgen.verify.oracle import PinocchioOracle
from ikgen.verify.task_space import task_space

__all__ = ["FLAT_FOLDS", "forearm_file", "forearm_under_test"]

_LIMIT = 2.9

FLAT_FOLDS = {
    "x": (
        (-1.5707962200457, -1.5709866688483656, 0.0005712538726697055, -1.5701289987403075,
         -1.5707962200457002),
        (2.629119761669, 1.570796395459, -2.070282507187e-07, -1.570796572266, 1.570796326717),
    ),
    "z": (
        (1.5707960247237078, 0.026553858245155902, -0.05518510189467428, 0.028631243526470763,
         1.5692072452998245),
        (1.5707963267948857, 0.0003661348910365897, -0.00076090603196781, 0.00039477114093121595,
         1.5707960247237893),
    ),
}  # fmt: skip
"""By the tool's axis that is wanted singular configurations of the arm of 1.571 rad, none on a continuum.
With 40 digits what is left of the pose a way s (rad) along the null direction, behind the other steps, is
9e-13 s^2 (x), and 4.6e-8 s^8 (z), where eight solutions meet."""


def forearm_file(path: Path, right: float = 1.571) -> Path:
    """Yaw, three parallel joints and a roll, between links l0 and tip, at right angles as rounded."""
    origins = (
        ("0 0 0.051", "0 0 0"),
        ("0 0 0", f"{right} 0 0"),
        ("0.193 0 0", "0 0 0"),
        ("0.179 0 0", "0 0 0"),
        ("0 0 0", f"{right} 0 0"),
    )
    return serial_urdf(path, origins, tip=("0.089 0 0.03", "0 0 0"), limit=_LIMIT)


def forearm_under_test(path: Path, axis: str) -> ArmUnderTest:
    """The arm of a file, for the position and the direction of the tool's axis."""
    tree = parse_urdf(path.read_text(), path=path)
    oracle = PinocchioOracle(tree, "l0", "tip", [f"j{k}" for k in range(5)])
    task = task_space(find_task("position-direction", axis))
    return arm_under_test(oracle, task, (oracle.lower, oracle.upper), ())
