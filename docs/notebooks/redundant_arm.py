# %% [markdown]
# # A redundant arm and its self-motion
#
# Seven joints for a pose of six freedoms: one joint is held, and its value is an input. Run it
# anywhere in the repository, after `pip install 'ikgen[notebooks]'`.

# %%
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import ikgen
from ikgen.report.skeleton_bones import skeleton

here = Path.cwd()
root = next((up for up in (here, *here.parents) if (up / "urdf_fixtures").is_dir()), here)
arm = ikgen.load(root / "urdf_fixtures/franka_fr3.urdf", samples=100)
print(arm)
print("held:", arm.free_joints)

# %% [markdown]
# One pose, solved at several values of the held joint:

# %%
q = np.array([0.3, 0.4, -0.2, -1.6, 0.1, 2.0, 0.5])
pose = arm.forward(q)
joint = arm.joint_names.index(arm.free_joints[0])
for value in q[joint] + np.array([-0.2, 0.0, 0.2]):
    found = arm.solve(pose, free=[value])
    print(f"{value:+.2f} rad: {len(found)} rows")
    assert np.allclose(arm.forward(found.q), pose, atol=1e-9)

# %% [markdown]
# On which intervals of its values there is a row inside the limits, branch by branch:

# %%
intervals = arm.self_motion(pose)
for interval in intervals:
    print(f"branch {interval.branch}: {interval.low:+.3f} to {interval.high:+.3f} rad")
assert any(one.low - 1e-6 <= q[joint] <= one.high + 1e-6 for one in intervals)

# %% [markdown]
# The same to look at. Above: rows inside the limits at every value, by one of the joints that follow.
# Below: the intervals, which begin and end where a limit or a singularity is met.

# %%
held = arm.free_joints[0]
values = np.linspace(arm.lower[joint], arm.upper[joint], 241)
rows, count, _ = arm.solve_batch(np.stack([pose] * len(values)), free=values[:, None])
figure, (above, below) = plt.subplots(2, 1, sharex=True, figsize=(8, 6), layout="constrained")
follows = next(k for k in range(arm.dof) if k != joint)
for value, found_rows, k in zip(values, rows, count, strict=True):
    above.plot([value] * k, found_rows[:k, follows], ".", color="tab:blue", markersize=3)
above.plot(q[joint], q[follows], "o", color="tab:red", label="where the arm stands")
above.set(ylabel=f"{arm.joint_names[follows]}, rad")
above.legend()
for interval in intervals:
    below.plot([interval.low, interval.high], [interval.branch] * 2, linewidth=6)
below.axvline(q[joint], color="tab:red")
below.set(xlabel=f"{held}, rad", ylabel="branch", yticks=sorted({one.branch for one in intervals}))
plt.show()
seen = sum(one.low <= value <= one.high for one in intervals for value in values)
assert abs(seen - count.sum()) <= 2 * len(intervals)  # at ends, by rounding

# %% [markdown]
# The arm on the branch on which it stands, over the whole of its interval; the hand stays where it is:

# %%
mine = next(
    one
    for one in intervals
    if one.low - 1e-6 <= q[joint] <= one.high + 1e-6
    and np.abs(arm.solve(pose, free=[q[joint]], seed=q)[0] - q).max() < 1e-6
)
figure, place = plt.subplots(subplot_kw={"projection": "3d"}, figsize=(7, 6), layout="constrained")
last = q
for value in q[joint] + np.linspace(0.0, 0.9 * (mine.high - q[joint]), 12):
    last = arm.solve(pose, free=[value], seed=last)[0]
    x, y, z = skeleton(arm.derivation.dh, last).points.T
    place.plot(x, y, z, "-", color=plt.cm.viridis((value - q[joint]) / (mine.high - q[joint])))
    assert np.allclose(arm.forward(last), pose, atol=1e-9)
place.scatter(*pose[:3, 3], color="tab:red")
place.set(box_aspect=(1, 1, 1), xlabel="x, m", ylabel="y, m", zlabel="z, m")
plt.show()

# %% [markdown]
# The best row over all values, near to where the arm stands:

# %%
best = arm.search(pose, seed=q)[0]
assert np.allclose(arm.forward(best), pose, atol=1e-9)
assert np.abs(best - q).max() < 1e-3
