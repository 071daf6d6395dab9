"""Generate a module for a robot, import it, and use all that it offers."""

from __future__ import annotations

import importlib
import subprocess
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
ROBOT = HERE.parents[1] / "urdf_fixtures/kuka_kr6r900sixx.urdf"
OUT = HERE / "out"


def main() -> None:
    """From the robot's file to joint values."""
    # 1. Generate out/kuka_ik.py. It is verified before it is written, and needs NumPy alone.
    command = [sys.executable, "-m", "ikgen", "from-urdf", ROBOT, "--name", "kuka", "-o", OUT, "-q"]
    subprocess.run(command, check=True)

    # 2. Import it, as any module.
    sys.path.insert(0, str(OUT))
    kuka = importlib.import_module("kuka_ik")
    print(f"{kuka.DOF} joints from {kuka.BASE_LINK} to {kuka.TIP_LINK}: {kuka.JOINT_NAMES}")

    # 3. A pose is a 4x4 matrix: the tip in the base, in m.
    pose = kuka.forward([0.2, -0.9, 1.1, 0.3, 0.6, -0.4])
    found = kuka.solve(pose)
    print(f"{len(found)} solutions inside the limits ({found.status.name}):")
    for q in found:
        assert np.allclose(kuka.forward(q), pose)
        print("  ", np.round(q, 4))

    # 4. With a seed the nearest comes first: where the robot is now.
    now = np.array([0.0, -1.2, 1.3, 0.0, 0.5, 0.0])
    nearest = kuka.solve(pose, seed=now).q[0]
    print("nearest to now:", np.round(nearest, 4))

    # 5. Out of reach is a status, not an exception.
    far = pose.copy()
    far[0, 3] += 5.0
    print("5 m further away:", kuka.solve(far).status.name)

    # 6. Many poses at once: a straight line of the tip.
    line = np.repeat(pose[None], 50, axis=0)
    line[:, 2, 3] += np.linspace(0.0, 0.1, 50)
    q, count, _ = kuka.solve_batch(line)
    print(
        f"{np.count_nonzero(count)} of {len(line)} poses of a line have solutions; q is {q.shape}"
    )

    # 7. Joint velocities for 0.1 m/s upwards, by the Jacobian (3 linear rows, 3 angular).
    speeds = np.linalg.solve(kuka.jacobian(nearest), [0.0, 0.0, 0.1, 0.0, 0.0, 0.0])
    print("rad/s for 0.1 m/s upwards:", np.round(speeds, 4))


if __name__ == "__main__":
    main()
