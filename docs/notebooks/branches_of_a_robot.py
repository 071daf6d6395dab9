# %% [markdown]
# # Solve a robot and look at its branches
#
# Opens as a notebook in Jupyter (with jupytext), VS Code and PyCharm; run it from the repository's
# folder.

# %%
import numpy as np

import ikgen

arm = ikgen.load("urdf_fixtures/kuka_kr6r900sixx.urdf", samples=100)
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
# Each row is a choice of one branch a joint. The derivation says where the branches come from:

# %%
for name, branches in arm.derivation.solutions.items():
    print(f"{name}: {len(branches)} branch{'es' if len(branches) > 1 else ''}")
choices = np.prod([len(branches) for branches in arm.derivation.solutions.values()])
assert len(found) <= choices == 8

# %% [markdown]
# The arm's three choices are the side of its shoulder, the elbow, and the turn of its wrist. With
# limits, and nearest to where the arm stands:

# %%
nearest = arm.solve(pose, seed=q).q[0]
assert np.allclose(nearest, q)
print(np.degrees(nearest).round(1))
