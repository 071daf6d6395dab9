"""Poses where one unknown after the other loses digits: a small arm of five joints, alone and on a base."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from benchmarks.agreement import arm_of, runner_of
from tests.support.sampled import in_languages
from tests.support.serial_urdf import serial_urdf

from ikgen.derivation.derive import derive
from ikgen.records.request import Request
from ikgen.verify.completeness import survey
from ikgen.verify.sampling import SampleSet
from ikgen.verify.trials import run_trial

pytestmark = pytest.mark.usefixtures("solved_once")

BASE = ("-0.1011647 -0.15 0.8349", "-3.14159 0 3.14159")
SHOULDER = ("0.0388353 0 0.0624", "3.14159 0 -3.14159")
ARM = [
    ("-0.0303992 -0.0182778 -0.0542", "-1.5708 -1.5708 0"), ("-0.11257 -0.028 0", "0 0 1.5708"),
    ("-0.1349 0.0052 0", "0 0 -1.5708"),
]  # fmt: skip
WRIST, ROLL = (
    ("0 -0.0611 0.0181", "1.5708 -9.38083e-08 3.14159"),
    ("0 -0.0611 0.0181", "1.5708 0.0486795 3.14159"),
)
NONE = ("0 0 0", "0 0 0")
GRIPPER = ("-0.0079 -0.000218121 -0.0981274", "0 3.14159 0")
ORIGINS = {
    "alone": [SHOULDER, *ARM, ROLL, GRIPPER],
    "on a mobile base": [NONE, NONE, NONE, BASE, *ARM, WRIST, NONE],
}
"""Where joints lie in those before, and the tip: rounded, the parallel ones as exactly as they are."""
LOST = {
    "alone": [
        [-1.1889211057975786, 1.6741212247772077, -1.2859859949427281, 0.079913570930973, 1.6087084915879],
        [0.32185067269893342, -0.9166041086513, -1.1473976739478899, 0.041764410222244301, 1.6194743135836],
    ],
    "on a mobile base": [
        [-1.01944687386349, 0.547253661953117, -1.3276837230719754, -1.37524927526251, 1.1064194943, 0.885],
        [-0.534697032166097, 0.5251981086825, 0.951038443337361, -1.26724930789446, -1.31077911, -0.253],
        [2.6702147820261883, 0.527049426788855, 1.18494812702136, -1.306618663213675, -1.622785, 1.153],
        [0.939937883056103, 0.50063876869647, -1.72139457660523, -1.48641012736336, 1.634744827, -0.339],
    ],
}  # fmt: skip
"""Configurations at whose poses there was no row, or others at 1e-6 from them."""


def robot(kind: str, folder: Path) -> Path:
    """The arm's file."""
    *moving, tip = ORIGINS[kind]
    slides = dict(enumerate(("1 0 0", "0 1 0"))) if len(moving) > 5 else {}
    return serial_urdf(folder / "small.urdf", moving, tip=tip, slides=slides, limit=2.8)


@pytest.mark.parametrize(("kind", "language"), in_languages(ORIGINS, []))
def test_none_is_without_a_row(kind: str, language: str, tmp_path: Path) -> None:
    held = {"j0": None, "j1": None} if "mobile" in kind else {}
    derivation = derive(Request(robot(kind, tmp_path), free=held))
    arm, random = arm_of(derivation), np.random.default_rng(2)
    q = np.repeat(LOST[kind], 8, axis=0)
    q = np.concatenate([np.full((len(q), arm.dof - q.shape[1]), 0.5), q], axis=1)  # slides
    q[len(LOST[kind]) :] += 1e-8 * random.normal(size=q[len(LOST[kind]) :].shape)
    sample = SampleSet("lost", q, arm.oracle.forward(q), arm.sigma(q))
    assert 1e-8 < np.median(sample.sigma) < 1e-3
    runner = runner_of(derivation, language, tmp_path)
    found = survey(arm, runner, [run_trial(runner, arm, sample, limits=True)])
    lost = np.flatnonzero(found.missed | found.unanswered)
    assert not len(lost), (len(lost), found.case(int(lost[0])))
