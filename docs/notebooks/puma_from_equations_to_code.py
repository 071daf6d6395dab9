# %% [markdown]
# # From the equations to the code: the Puma 560
#
# Step by step, as in Zhang and Hannaford, *IKBT: solving closed-form inverse kinematics with
# behavior tree*, 2017, with the numbers of its table "Puma 560 Numerical Solutions". Run it from
# the repository's folder.

# %%
from pathlib import Path

import numpy as np
import sympy

from ikgen.generation.derive import derive
from ikgen.generation.request import Request
from ikgen.symbolic import equations, prove, solutions

derivation = derive(Request(Path("urdf_fixtures/puma560_paper.toml")))
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
assert len(rows) == 8
own = np.array([30.0, 50.0, 40.0, 45.0, 120.0, 60.0])
assert np.abs(rows - own).max(axis=1).min() < 1e-2
