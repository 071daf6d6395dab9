"""Arms whose joints move fewer freedoms than the task fixes: in one plane, or one of them not the tip."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.support.both_languages import Both, in_both
from tests.support.redundant_arms import Joint, serial_urdf
from tests.support.sampled import sampled
from tests.support.solving import NO_COMPILER

from ikgen.derivation.derive import derive
from ikgen.generation.generate import generate
from ikgen.records.request import Outputs, Request

pytestmark = [
    pytest.mark.usefixtures("solved_once"),
    pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER or "compiles"),
]

ARMS: dict[str, tuple[Joint, ...]] = {
    "four_turn": (
        ("a", "revolute", "0 1 0", "0 0 0.1", (-3.0, 3.0)),
        ("b", "revolute", "0 1 0", "0 0 0.4", (-2.5, 2.5)),
        ("c", "revolute", "0 1 0", "0 0 0.3", (-2.5, 2.5)),
        ("d", "revolute", "0 1 0", "0 0 0.2", (-2.5, 2.5)),
    ),
    "on_a_slide": (
        ("rail", "prismatic", "1 0 0", "0 0 0.1", (0.0, 0.5)),
        ("a", "revolute", "0 1 0", "0 0 0.1", (-2.6, 2.6)),
        ("b", "revolute", "0 1 0", "0 0 0.3", (-2.6, 2.6)),
        ("c", "revolute", "0 1 0", "0 0 0.2", (-2.6, 2.6)),
    ),
}


@pytest.fixture(scope="module")
def both(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Both:
    name = request.param
    folder = tmp_path_factory.mktemp(name)
    path = folder / f"{name}.urdf"
    path.write_text(serial_urdf(name, ARMS[name]))
    module = derive(Request(path, name=name)).module
    assert (module.task, len(module.held), module.freedoms) == ("pose", 1, 3)
    return in_both(module, folder, "34" if name == "four_turn" else "4")


@pytest.mark.parametrize("both", sampled(ARMS, ["four_turn"]), indirect=True)
def test_a_path_is_singular_only_where_all_joints_lose_a_freedom(both: Both) -> None:
    four_turn = both.arm.JOINT_NAMES[0] == "a"
    bent = np.array([0.2, 0.5, -0.7, 0.9])
    poses = both.arm.forward(np.stack([bent, bent + 0.01]))
    status, flags, rows = both.follow(bent, poses)
    assert (status, flags) == ("OK", 0)
    assert not both.arm.follow(poses, start=bent).singular.any()
    np.testing.assert_allclose(both.arm.forward(rows), poses, atol=1e-9)
    # those that turn stand in line, and the slide goes along with them
    straight = np.zeros(4) if four_turn else np.array([0.2, np.pi / 2, 0.0, 0.0])
    pose = both.arm.forward(straight[None])
    assert both.follow(straight, pose)[1] == four_turn
    assert both.arm.follow(pose, start=straight).singular[0] == four_turn


@pytest.mark.parametrize("both", ["four_turn"], indirect=True)
def test_the_most_dexterous_row_is_the_same_in_both_languages(both: Both) -> None:
    for q in np.random.default_rng(1).uniform(-1.5, 1.5, (4, 4)):
        pose = both.arm.forward(q)
        row = both.run(3, q, pose[None])[1][:4]
        own = both.arm.search(pose, seed=q, prefer="dexterous").q[0]
        least = np.linalg.svd(both.arm.jacobian(np.stack([row, own])), compute_uv=False)[:, 2]
        assert least[0] == pytest.approx(least[1], abs=1e-5)
        assert least[1] >= np.linalg.svd(both.arm.jacobian(q), compute_uv=False)[2] - 1e-9


def test_such_an_arm_is_verified(tmp_path: Path) -> None:
    path = tmp_path / "four_turn.urdf"
    path.write_text(serial_urdf("four_turn", ARMS["four_turn"]))
    made = generate(Request(path), Outputs(out=tmp_path, samples=60))
    assert made.reports["python"].passed


IDLE: tuple[Joint, ...] = (
    ("a", "revolute", "0 0 1", "0 0 0.1", (-3.0, 3.0)),
    ("b", "revolute", "0 1 0", "0.2 0 0.1", (-2.5, 2.5)),
    ("c", "revolute", "1 0 0", "0.3 0 0", (-2.5, 2.5)),
)
"""The last axis goes through its own frame, whose position it does not move."""


@pytest.mark.long
def test_a_joint_that_leaves_the_position_makes_no_row_singular(tmp_path: Path) -> None:
    path = tmp_path / "idle.urdf"
    path.write_text(serial_urdf("idle", IDLE))
    request = Request(path, tip="c_link", name="idle", task="position", free={"c": None})
    both = in_both(derive(request).module, tmp_path, "34")
    bent = np.array([0.2, 0.5, -0.7])
    poses = both.arm.forward(np.stack([bent, bent + np.array([0.01, 0.02, 0.0])]))
    status, flags, rows = both.follow(bent, poses)
    assert (status, flags) == ("OK", 0)
    assert not both.arm.follow(poses, start=bent).singular.any()
    np.testing.assert_allclose(both.arm.forward(rows)[:, :3, 3], poses[:, :3, 3], atol=1e-9)
    assert both.run(3, bent, poses[:1])[0] == "OK"
