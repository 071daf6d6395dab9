# %% [markdown]
# # A redundant arm and its self-motion
#
# Seven joints for a pose of six freedoms: one joint is held, and its value is an input. Run it from
# the repository's folder.

# %%
import numpy as np

import ikgen

arm = ikgen.load("urdf_fixtures/franka_fr3.urdf", samples=100)
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
# The best row over all values, near to where the arm stands:

# %%
best = arm.search(pose, seed=q).q[0]
assert np.allclose(arm.forward(best), pose, atol=1e-9)
assert np.abs(best - q).max() < 1e-3
