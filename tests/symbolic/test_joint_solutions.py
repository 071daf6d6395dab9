"""The solutions in SymPy give the rows that the emitted module gives."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
import sympy
from numpy.typing import NDArray
from tests.support.sampled import sampled
from tests.support.solving import FIXTURES, import_text
from tests.support.symbolic_rows import symbolic_rows

from ikgen.derivation.derive import derive
from ikgen.emit.derivation import Derivation
from ikgen.emit.python.python_emitter import emit_module
from ikgen.records.request import Request
from ikgen.symbolic import equations, prove, solutions

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

pytestmark = pytest.mark.usefixtures("solved_once")

Array = NDArray[np.float64]
ROBOTS = Path(__file__).resolve().parents[1] / "robots"
EXPECTED = tomllib.loads((ROBOTS / "expected.toml").read_text(encoding="utf-8"))
SOLVED = [name for name, facts in EXPECTED.items() if not facts["redundant"]]
SAME = 1e-6


def _configurations(module: ModuleType, count: int, size: float) -> Array:
    """Random joint values (count, dof), the less singular half of what was drawn."""
    drawn = np.random.default_rng(5).uniform(-2.5, 2.5, (2 * count, module.DOF))
    unit = np.array([1.0, 1.0, 1.0, size, size, size])
    sigma = [np.linalg.svd(module.jacobian(q) * unit[:, None], compute_uv=False)[-1] for q in drawn]
    return np.asarray(drawn[np.argsort(sigma)[count:]])


def _check(derivation: Derivation, count: int, folder: Path) -> None:
    """Every emitted row is one of the symbolic ones, and the other way round."""
    module = import_text(emit_module(derivation.module), folder)
    size = max(1.0, float(np.abs(module.forward(np.ones(module.DOF))[:3, 3]).max()))
    q = _configurations(module, count, size)
    poses = module.forward(q)
    rows, counts, _ = module.solve_batch(poses, limits=False)
    made = symbolic_rows(derivation, poses)
    i, j = np.transpose(derivation.task.entries)  # what the task reads
    off = np.abs(module.forward(np.nan_to_num(made)) - poses[:, None])
    back = off[..., i, j].max(axis=-1)
    right = np.isfinite(made).all(axis=-1) & (back < SAME * size)
    assert counts.min() >= 1
    for i in range(count):
        emitted, symbolic = rows[i, : counts[i]], made[i][right[i]]
        assert len(symbolic), f"no row at {q[i]}"
        difference = emitted[:, None] - symbolic[None]
        for j, joint in enumerate(derivation.graph.dh.joints):
            d = difference[..., j]
            turned = np.abs(np.arctan2(np.sin(d), np.cos(d)))
            difference[..., j] = turned if joint.kind == "revolute" else d / size
        gap = np.abs(difference).max(axis=-1)
        assert gap.min(axis=1).max() < SAME, f"an emitted row at {q[i]} is in no branch"
        assert gap.min(axis=0).max() < SAME, f"a branch at {q[i]} is not emitted"


@pytest.mark.parametrize("name", SOLVED)
def test_every_table_is_proved_and_its_rows_are_those_of_the_emitted_module(
    name: str, tmp_path: Path
) -> None:
    derivation = derive(Request(ROBOTS / "tables" / f"{name}.toml"))
    proof = prove(derivation)
    if derivation.module.plan is not None:
        assert not solutions(derivation) and "elimination" in proof.reason
        return
    assert proof.proved and proof.equations, proof.remarks
    assert len(proof.patterns) >= len(derivation.graph.steps)
    _check(derivation, 20, tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("name", sampled(SOLVED, ("Puma", "Olson13", "Parkman13")))
def test_rows_of_a_thousand_poses(name: str, tmp_path: Path) -> None:
    derivation = derive(Request(ROBOTS / "tables" / f"{name}.toml"))
    if derivation.module.plan is not None:
        pytest.skip("an elimination has no symbolic solution")
    _check(derivation, 1000, tmp_path)


def test_what_a_branch_says() -> None:
    """Puma's first joint, as the paper has it (IKBT, table of solutions)."""
    found = solutions(derive(Request(FIXTURES / "puma560_paper.toml")))
    assert list(found) == [f"theta_{k}" for k in (1, 3, 2, 4, 5, 6)]
    one, two = found["theta_1"]
    p_x, p_y, d_3 = sympy.symbols("p_x p_y d_3", real=True)
    swing = sympy.atan2(sympy.sqrt(p_x**2 + p_y**2 - d_3**2), d_3)
    assert one.expression - swing == two.expression + swing == sympy.atan2(-p_x, p_y)
    assert sympy.Ge(p_x**2 + p_y**2 - d_3**2, 0) in one.conditions
    assert sympy.Ne(p_x**2 + p_y**2, 0) in one.conditions


def test_the_page_runs(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(FIXTURES.parent)
    page = (FIXTURES.parent / "docs/how-to/sympy.md").read_text()
    code = re.search(r'^```python title="sympy"\n(.*?)^```', page, re.M | re.S)
    assert code is not None
    exec(compile(code.group(1), "sympy.md", "exec", dont_inherit=True), {})
    said = capsys.readouterr().out.splitlines()
    promised = re.findall(r"  # (Eq.*|proved: 10 of 10 equations)", code.group(1))
    assert len(promised) == 2 and said[-2] == promised[0] and said[-1].startswith(promised[1])


def test_only_what_was_solved_before_is_used() -> None:
    for name in ("puma560_paper", "olson13"):
        found = solutions(derive(Request(FIXTURES / f"{name}.toml")))
        known: set[sympy.Symbol] = set()
        for branches in found.values():
            for branch in branches:
                used = {s for s in branch.expression.free_symbols if s.name.startswith("theta")}
                assert used <= known
            known.add(branches[0].variable)


def test_equations_are_those_of_the_paper() -> None:
    p_x, p_y, d_3, theta_1 = sympy.symbols("p_x p_y d_3 theta_1", real=True)
    found = equations(derive(Request(FIXTURES / "puma560_paper.toml")))
    wanted = d_3 + p_x * sympy.sin(theta_1) - p_y * sympy.cos(theta_1)
    assert wanted in [e.lhs - e.rhs for e in found]
