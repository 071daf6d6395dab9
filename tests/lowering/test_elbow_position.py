"""Where the elbow is by the arm angle: the same place as by the joints."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from tests.support.redundant_arms import OFFSET_ELBOW, SHOULDER_ELBOW_WRIST, serial_urdf

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.derivation.read import read
from ikgen.equations.equation_set import EquationSet
from ikgen.equations.knowledge import Knowledge
from ikgen.equations.probes import arm_size, make_probes
from ikgen.lowering.elbow_position import bind_elbow
from ikgen.lowering.held_angle import held_angle
from ikgen.lowering.placement import Placement
from ikgen.program.inputs import ArmAngle
from ikgen.program.ops import Op
from ikgen.program.statements import Comment
from ikgen.records.request import Request


def placement(
    folder: Path, joints: tuple, *, free: str = "arm-angle"
) -> tuple[Placement, np.ndarray]:
    """A Placement before any step, its arm angle that of the probes (N,)."""
    path = folder / "arm.urdf"
    path.write_text(serial_urdf("arm", joints))
    dh = read(Request(path, free={free: None})).dh
    probes = make_probes(dh)
    graph = ExpressionGraph(len(probes.values))
    system = EquationSet(graph, dh, probes.values, probes.pose, kept=probes.kept)
    found = held_angle(dh)
    angle = np.zeros(len(probes.values))
    if found is not None:
        leads = [dh.lead_row(j) for j in range(dh.dof)]
        q = (probes.values - [r.offset.value for r in leads]) / [r.scale for r in leads]
        angle = found.of_rows(q, dh.X_base @ probes.pose @ dh.X_tip)
    for name, values in (("c_arm", np.cos(angle)), ("s_arm", np.sin(angle))):
        graph.atom("input", name, values, unknown=False)
    stub = SimpleNamespace(
        dh=dh, held=dh.free_indices, probes=probes, steps=(), workspace=lambda: Knowledge(system)
    )
    return Placement(stub, 0.0), angle  # type: ignore[arg-type]


def nodes(work: Placement) -> set[Expr]:
    """All that the elbow is computed from."""
    found: set[Expr] = set()
    stack = [work.definition[atom.id] for atom in work.system.elbow]
    while stack:
        node = stack.pop()
        if node not in found:
            found.add(node)
            stack += node.args
    return found


@pytest.mark.parametrize("joints", [SHOULDER_ELBOW_WRIST, OFFSET_ELBOW], ids=["upright", "offset"])
def test_the_elbow_is_where_the_joints_put_it(joints: tuple, tmp_path: Path) -> None:
    work, angle = placement(tmp_path, joints)
    bind_elbow(work)
    assert np.ptp(angle) > 3.0
    for atom in work.system.elbow:
        at, truth = work.definition[atom.id].probe, atom.probe
        clear = slice(0, work.probes.generic)
        np.testing.assert_allclose(at[clear], truth[clear], atol=1e-12)
        np.testing.assert_allclose(at, truth, atol=1e-6)
    assert np.ptp([atom.probe for atom in work.system.elbow], axis=1).min() > 0.1
    assert [work.names[atom.id] for atom in work.system.elbow] == ["elbow_x", "elbow_y", "elbow_z"]
    (least,) = {e.args[1].value for e in nodes(work) if e.op == "max" and e.args[1].is_const}
    assert least == pytest.approx((1e-12 * arm_size(work.dh)) ** 2, rel=1e-12, abs=0.0)
    assert work.inputs == [ArmAngle()]
    given = ArmAngle().name
    assert [(let.name, let.value) for let in work.prelude] == [
        ("c_arm", Op("cos", (given,))), ("s_arm", Op("sin", (given,))),
    ]  # fmt: skip
    items = work.levels[0].items
    assert items[-1] is work.system.elbow[2] and Comment("the elbow") in items


def test_a_held_joint_needs_no_elbow(tmp_path: Path) -> None:
    work, _ = placement(tmp_path, SHOULDER_ELBOW_WRIST, free="wrist_roll")
    bind_elbow(work)
    assert not work.inputs and not work.prelude and not work.levels[0].items
