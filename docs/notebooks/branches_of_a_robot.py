# %% [markdown]
# # Solve a robot and look at its branches
#
# Opens as a notebook in Jupyter (with jupytext), VS Code and PyCharm; run it anywhere in
# the repository, after `pip install 'ikgen[notebooks]'`.

# %%
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import ikgen
from ikgen.report.skeleton_bones import skeleton

here = Path.cwd()
root = next((up for up in (here, *here.parents) if (up / "urdf_fixtures").is_dir()), here)
arm = ikgen.load(root / "urdf_fixtures/kuka_kr6r900sixx.urdf", samples=100)
print(arm)

# %% [markdown]
# A pose that the arm can take, and all the ways to take it:

# %%
q = np.array([0.2, -0.9, 1.1, 0.3, 0.6, -0.4])
pose = arm.forward(q)
found = arm.solve(pose, limits=False)
print(np.degrees(found.q).round(1))
assert np.allclose(arm.forward(found.q), pose, atol=1e-9)

# %% [markdown]
# They are told apart by the side of the shoulder, the elbow, and the turn of the wrist. Each drawn from
# the same side, the flange at the same place:

# %%
assert len(set(found.branch)) == len(found) == 8
figure, places = plt.subplots(
    2, 4, subplot_kw={"projection": "3d"}, figsize=(12, 6.5), layout="constrained"
)
for place, row, name in zip(places.flat, found, found.branch, strict=True):
    x, y, z = skeleton(arm.derivation.dh, row).points.T
    place.plot(x, y, z, "-o", linewidth=2, markersize=3)
    place.scatter(*pose[:3, 3], color="tab:red")
    place.set(xlim=(-0.3, 0.8), ylim=(-0.5, 0.6), zlim=(0.0, 1.1), box_aspect=(1, 1, 1))
    place.set_title(name.replace("wrist", "\nwrist"), fontsize=8)
plt.show()

# %% [markdown]
# Each row is a choice of one branch a joint. The derivation says where the branches come from:

# %%
for name, branches in arm.derivation.solutions.items():
    print(f"{name}: {len(branches)} branch{'es' if len(branches) > 1 else ''}")
choices = np.prod([len(branches) for branches in arm.derivation.solutions.values()])
assert len(found) <= choices == 8

# %% [markdown]
# With limits, and nearest to where the arm stands:

# %%
nearest = arm.solve(pose, seed=q)[0]
assert np.allclose(nearest, q)
print(np.degrees(nearest).round(1))
