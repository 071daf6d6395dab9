# %% [markdown]
# # From the equations to the code: the Puma 560
#
# Step by step, as in Zhang and Hannaford, *IKBT: solving closed-form inverse kinematics with
# behavior tree*, 2017, with the numbers of its table "Puma 560 Numerical Solutions". Run it
# anywhere in the repository, after `pip install 'ikgen[notebooks]'`.

# %%
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import sympy

from ikgen.derivation.derive import derive
from ikgen.records.request import Request
from ikgen.symbolic import equations, prove, solutions

here = Path.cwd()
root = next((up for up in (here, *here.parents) if (up / "urdf_fixtures").is_dir()), here)
derivation = derive(Request(root / "urdf_fixtures/puma560_paper.toml"))
print(derivation.geometry.words)

# %% [markdown]
# The matrix equations that were used, and the solution of the first joint:

# %%
used = equations(derivation)
for equation in used[:4]:
    sympy.pprint(equation)
found = solutions(derivation)
for branch in found["theta_1"]:
    sympy.pprint(branch.expression)

# %% [markdown]
# They hold for every pose:

# %%
proof = prove(derivation)
print(proof.words)
assert proof.proved and len(proof.equations) == len(used) == 10

# %% [markdown]
# The paper's pose, and its first joint from the formula:

# %%
pose = np.array(
    [
        [-0.15720, 0.97938, 0.12682, -1.68074],
        [-0.59374, -0.19635, 0.78032, 1.33902],
        [0.78914, 0.04737, 0.61237, -4.83022],
        [0.0, 0.0, 0.0, 1.0],
    ]
)
p_x, p_y, d_3 = sympy.symbols("p_x p_y d_3", real=True)
given = {p_x: pose[0, 3], p_y: pose[1, 3], d_3: 2}
first = sorted(float(branch.expression.subs(given)) for branch in found["theta_1"])
print(np.degrees(first))  # the paper has 29.99995 and -287.08771
assert np.allclose(np.mod(np.degrees(first), 360.0), [29.99995, 72.91229], atol=1e-3)

# %% [markdown]
# Both are zeros of one equation, $p_y \cos\theta_1 - p_x \sin\theta_1 = d_3$. A pose nearer to the
# first axis moves them together, until the arm can't reach it:

# %%
theta_1 = sympy.Symbol("theta_1", real=True)
wanted = d_3 + p_x * sympy.sin(theta_1) - p_y * sympy.cos(theta_1)
assert wanted in [equation.lhs - equation.rhs for equation in used]
angles = np.linspace(-np.pi, np.pi, 400)
figure, place = plt.subplots(figsize=(8, 4), layout="constrained")
for nearer in (1.0, 0.95, 0.9):
    left = wanted.subs({p_x: nearer * pose[0, 3], p_y: nearer * pose[1, 3], d_3: 2})
    values = sympy.lambdify(theta_1, left)(angles)
    place.plot(np.degrees(angles), values, label=f"{nearer:g} of the distance")
place.plot(np.degrees(first), [0.0, 0.0], "o", color="black", label="the two branches")
place.axhline(0.0, color="gray", linewidth=0.8)
place.set(xlabel="theta_1, degrees", ylabel="left side minus right side")
place.legend()
plt.show()

# %% [markdown]
# The same formulas as code, which finds all eight rows of the table:

# %%
from ikgen.emit.python.python_emitter import emit_module  # noqa: E402

text = emit_module(derivation.module)
print(text.count("\n"), "lines")

# %%
import importlib.util  # noqa: E402
import sys  # noqa: E402
import tempfile  # noqa: E402

with tempfile.TemporaryDirectory() as folder:
    file = Path(folder) / "puma560_ik.py"
    file.write_text(text)
    spec = importlib.util.spec_from_file_location("puma560_ik", file)
    assert spec is not None and spec.loader is not None
    puma = sys.modules["puma560_ik"] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(puma)
clean, _, turned = np.linalg.svd(pose[:3, :3])  # the table has five digits
pose[:3, :3] = clean @ turned
rows = np.degrees(puma.solve(pose, limits=False).q)
print(rows.round(3))

# %% [markdown]
# The paper's table, as it stands there; its digits are those of its pose:

# %%
paper = np.array(
    [
        [-287.08771, 130.00008, -191.92745, -6.78054, -66.24462, 4.13687],
        [29.99995, 49.99992, 39.99994, -135.00007, -119.99981, -120.00010],
        [29.99995, 148.48625, -191.92745, 142.01103, 95.78709, -151.06756],
        [-287.08771, 31.51375, 39.99994, 18.00641, 159.53838, 18.33206],
        [-287.08771, 130.00008, -191.92745, 173.21946, 66.24462, -175.86313],
        [29.99995, 148.48625, -191.92745, -37.98897, -95.78709, 28.93244],
        [29.99995, 49.99992, 39.99994, 44.99993, 119.99981, 59.99990],
        [-287.08771, 31.51375, 39.99994, -161.99359, -159.53838, -161.66794],
    ]
)
apart = np.abs((rows[:, None] - paper[None] + 180.0) % 360.0 - 180.0).max(axis=2)
assert len(rows) == len(paper) == 8
assert apart.min(axis=0).max() < 3e-3 and apart.min(axis=1).max() < 3e-3

# %% [markdown]
# Two values of $\theta_1$, two of $\theta_3$ for each, two of $\theta_4$ for each of those, all others
# follow: a tree whose ends are the eight rows.

# %%
figure, place = plt.subplots(figsize=(8, 5), layout="constrained")
order = [0, 2, 3]  # theta_1, theta_3, theta_4
for row in (rows + 180.0) % 360.0 - 180.0:
    place.plot(range(4), [0.0, *row[order]], "-o", color="tab:blue", alpha=0.6)
place.set_xticks(range(4), ["pose", "theta_1", "theta_3", "theta_4"])
place.set(ylabel="degrees, -180 to 180")
plt.show()
