"""Defaults of held joints lie inside their limits."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path

import pytest

from ikgen.cli.main import run
from ikgen.derivation.read import read
from ikgen.errors import UsageError
from ikgen.kinematics.free_joints import free_defaults
from ikgen.model.joint_tree import Limits
from ikgen.records.request import Request

FIXTURES = Path(__file__).resolve().parents[2] / "urdf_fixtures"
FR3 = FIXTURES / "franka_fr3.urdf"
HELD = "fr3_joint7"


def default(lower: float, upper: float, value: float | None = None) -> float:
    """Of one held joint with these limits."""
    dh = read(Request(FR3, free={HELD: None})).dh
    last = dataclasses.replace(dh.joints[-1], limits=Limits(lower, upper))
    dh = dataclasses.replace(dh, joints=(*dh.joints[:-1], last))
    (found,) = free_defaults(dh, [(HELD, value)])
    return found


@pytest.mark.parametrize(
    ("limits", "expected"),
    [
        ((-1.0, 2.0), 0.0),
        ((1.0, 2.0), 1.5),
        ((0.05, math.inf), 0.05),
        ((-math.inf, -0.5), -0.5),
        ((-math.inf, math.inf), 0.0),
    ],
)
def test_none_given(limits: tuple[float, float], expected: float) -> None:
    assert default(*limits) == expected


def test_a_given_value_is_taken_up_to_the_limits() -> None:
    assert default(-1.0, 2.0, 2.0) == 2.0
    with pytest.raises(UsageError, match="-1 to 2"):
        default(-1.0, 2.0, 2.1)


def test_one_at_which_the_others_are_always_singular_is_left() -> None:
    """At 0 the joint before and the one after it turn about one line."""
    dh = read(Request(FR3, free={"fr3_joint2": None})).dh
    assert free_defaults(dh, []) == pytest.approx((0.5 * dh.joints[1].limits.upper,))
    assert free_defaults(dh, [("fr3_joint2", 0.0)]) == (0.0,)


def test_a_value_outside_is_refused_before_the_search(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    assert run(["from-urdf", str(FR3), "--free", f"{HELD}=50", "-o", str(out)]) == 2
    message = capsys.readouterr().err
    assert f"--free {HELD}=50: outside its limits, -3.0159 to 3.0159" in message
    assert "derive" not in message and not out.exists()
