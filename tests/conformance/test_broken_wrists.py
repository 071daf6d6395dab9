"""Wrists whose axes miss each other by a fraction of a millimetre: beside their singularity two further
solutions lie between those of the closed form."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.both_languages import emitted_in_both
from tests.support.row_gaps import gaps_in_both
from tests.support.serial_urdf import serial_urdf
from tests.support.solving import NO_COMPILER

from ikgen.records.request import Request

pytestmark = [
    pytest.mark.usefixtures("solved_once"),
    pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER or "compiles"),
]

Array = NDArray[np.float64]

ORIGINS = (
    ("0 0 0.003445", "3.141592653589793 0 0"),
    ("0 0.064146 -0.16608", "1.5708 0.5236 -1.5708"),
    ("0.1525 -0.26414 0", "0 0 -1.04720367321"),
    ("0 0 0.00675", "1.5708 -1.2554 -1.5708"),
    ("0 0 -0.22225", "3.141592653589793 0 -2.8262"),
    ("-0.000294 0 0.02117", "0 0 3.1416"),
)
AXES = ("0 0 1", "0 0 -1", "0 0 -1", "0 0 -1", "1 0 0", "0 0 1")
BETWEEN = np.array(
    [
        [2.0905339814, 1.4146526577, 1.5518611857, 1.4529094216, -0.0000451587, -0.0869394404],
        [1.8481867791, 1.4258924478, 1.6305770628, 1.5552706805, 0.0, -2.1846441479],
        [0.7853865857, 1.5706230436, 1.5705413890, 1.5706824432, -0.0001946026, -0.3245948452],
        [-1.4419767272, 1.4931770810, 1.4805707040, 1.6993919416, -0.0000024164, -1.5608902723],
        [2.6172615985, 1.4646689679, 1.5958569706, 1.7177986402, 0.0001266857, 0.3887287303],
    ]
)
SHOULDER_TOO = (  # axes that nearly meet at the shoulder as well
    ("0 0 0.156425", "-3.1416 0 0"),
    ("0 0.005375 -0.12838", "1.5708 0 0"),
    ("0 -0.41 0", "3.1416 0 0"),
    ("0 0.208425 -0.006375", "1.5708 0 0"),
    ("0 -0.00017505 -0.10592505", "-1.5708 0 0"),
    ("0 0.105925 -0.00017505", "1.5708 0 0"),
)
CROSSING = np.array(  # where the wrist's broken continuum crosses the shoulder's
    [
        [-1.82019090909, 0.85851872976, 2.22003411278, -2.63275567688, -0.00291534142, -0.50259636322],
        [3.03919904483, -0.85758470941, -2.21392757543, 0.37146287668, -0.00267008175, 2.77880474828],
        [-2.19654874450, 0.87999109561, 2.42574645592, 0.50903434300, 0.00000000570, 1.41686975322],
        [-1.01520565189, 0.86658285009, 2.46740579128, 2.03910786843, 0.00000012302, -2.63178438787],
        [-1.26982983779, -0.53942633859, -1.25882290791, -2.36618037870, 0.0, -2.44842484104],
        [-1.03849334544, 0.88011313695, 2.37670651352, -2.49117813919, 0.00309636234, -2.46514456638],
    ]
)  # fmt: skip

BESIDE_A_FOLD = (  # the wrist's continuum crosses the curve along which the elbow is nearly stretched
    ("0 0 0.414", "0 0 0"),
    ("0.562986 -0.451922 -0.000118", "-1.5708 -1.5708 0"),
    ("0.572938 4.9e-05 0", "0 0 0"),
    ("-0.222985 0.271902 0", "-1.5708 0 0"),
    ("0.000115 -9.8e-05 -2.1e-05", "1.5708 0 0"),
    ("-6.9e-05 5.6e-05 0", "-1.5708 0 0"),
)

BESIDE_ANOTHER = (  # the wrist's continuum nearly meets another curve where the elbow is folded back
    ("0 0 0.123", "0 0 0"),
    ("0 0 0", "1.5708 -0.1359 -3.1416"),
    ("0.28503 0 0", "0 0 -1.7939"),
    ("-0.021984 -0.25075 0", "1.5708 0 0"),
    ("0 0 0", "-1.5708 0 0"),
    ("0 -0.091 0", "1.5708 0 0"),
)
TURNING = np.array(
    [
        [-1.92842000382, 2.56249035140, -2.967, 0.01983831137, 4.62646801e-8, -1.00812626948],
        [-2.55583323880, 1.45168803208, -2.967, 0.09858965117, 5.52235299e-9, -0.95762846113],
    ]
)  # fmt: skip

AT_THE_CROSSING = (  # axes 4 to 6 of the arm miss each other by 0.07 mm, and the wrist's are tilted by 8e-6
    ("0.0272776 0.106003 0.235236", "0.423202 0 -0.261799"),
    ("0.0500248 0.123987 1.31115e-05", "-0.129894 -0.000368173 -0.000368543"),
    ("-0.037 0 -0.127", "0 0 0"),
    ("0 0.0295 -0.1245", "0 0 0"),
    ("2.03519e-09 -0.02945 -0.106", "2.32719e-08 4.03082e-08 -1.06004e-10"),
    ("-7.5629e-08 -0.01 -0.179", "0 -0.0872744 -7.56289e-06"),
    ("0 0 0", "9.33556e-07 0 0"),
)

AT_THE_CROSSING_LIMITS = (
    *((-2.356, 0.7854), (-2.618, 0.2618), (-1.833, 1.833), (-1.92, 0.08727)),
    *((-1.484, 1.484), (-0.384, 0.5585), (-0.733, 1.012)),
)


def gaps(path: Path, configurations: Array, folder: Path) -> Array:
    """How far (2, N) the nearest row is from each of many beside these, in both languages."""
    arm, header = emitted_in_both(Request(path, name="wrist"), folder)
    random = np.random.default_rng(1)
    q = configurations[np.arange(120) % len(configurations)]
    q = q + random.normal(size=q.shape) * 10.0 ** random.uniform(-7, -5, (len(q), 1))
    return gaps_in_both(arm, header, q)


@pytest.mark.long
def test_solutions_between_those_of_the_closed_form_are_found(tmp_path: Path) -> None:
    path = serial_urdf(tmp_path / "wrist.urdf", ORIGINS, axes=AXES, limit=3.1)
    assert gaps(path, BETWEEN, tmp_path).max() < 1e-3


@pytest.mark.long
def test_solutions_on_curves_that_cross_are_found(tmp_path: Path) -> None:
    tool = ("0 0 -0.061525", "3.1416 0 -3.1416")
    path = serial_urdf(tmp_path / "wrist.urdf", SHOULDER_TOO, tip=tool, limit=3.1)
    assert gaps(path, CROSSING, tmp_path).max() < 1e-3


def test_curves_that_cross_beside_a_fold_are_found(tmp_path: Path) -> None:
    """The direction that moves the pose least turns there from one curve to the other."""
    tool = ("0 0 0.129", "0 0 0")
    path = serial_urdf(tmp_path / "wrist.urdf", BESIDE_A_FOLD, tip=tool, limit=3.2)
    folded_back = np.pi / 4 * np.array([[0.0, -3.0, -3.0, 3.0, 4.0, -4.0]])
    assert gaps(path, folded_back, tmp_path).max() < 1e-5


def test_solutions_beside_a_curve_that_comes_near_are_found(tmp_path: Path) -> None:
    """Between two samples the direction that is left turns round there."""
    tool = ("0 0 0.1358", "0 -1.57 0")
    path = serial_urdf(tmp_path / "wrist.urdf", BESIDE_ANOTHER, tip=tool, limit=3.1)
    arm, header = emitted_in_both(Request(path, name="wrist"), tmp_path)
    assert gaps_in_both(arm, header, TURNING).max() < 1e-3


def test_solutions_where_curves_cross_are_found(tmp_path: Path) -> None:
    """Regular ones, which lie where samples of either curve go astray to the other."""
    axes = ("0 1 0", "-1 0 0", "0 0 -1", "0 1 0", "0 0 -1", "-7.53411e-06 1 6.59209e-07", "-1 0 0")
    tool = ("0 0 -0.0230879", "0 0 0")
    path = serial_urdf(
        tmp_path / "wrist.urdf", AT_THE_CROSSING, axes=axes, tip=tool, limit=AT_THE_CROSSING_LIMITS
    )
    q = np.array(
        [-2.2057, -0.2919340605, -1.5599661038, 0.0, -0.9241405614, 0.4190412404, -0.6661664260]
    )
    q = np.repeat(q[None], 40, axis=0)
    q[:, 3] = -0.0024 + 1e-5 * np.arange(-20, 20)
    arm, header = emitted_in_both(Request(path, name="wrist", free={"j0": -2.2057}), tmp_path)
    assert gaps_in_both(arm, header, q).max() < 1e-4


def test_a_short_curve_leads_to_the_broken_continuum_that_it_crosses(tmp_path: Path) -> None:
    """With the wrist straight no branch comes near a solution that the other joints of it turn away from:
    those beside lie on a curve that ends after a step, and crosses the wrist's."""
    file = Path(__file__).parents[2] / "urdf_fixtures" / "doosan_m1013.urdf"
    arm, header = emitted_in_both(Request(file), tmp_path)
    random = np.random.default_rng(0)
    q = np.repeat(
        [[-1.261888674, -2.512877859, -1.336984272, 0.557552949, 0.0, 2.097589591]], 80, 0
    )
    q += random.normal(size=q.shape) * np.repeat([[1e-9], [1e-6], [1e-5], [3e-4]], 20, axis=0)
    q[::2, 4] = 0.0
    assert gaps_in_both(arm, header, q).max() < 1e-3


ROLLS_ON_ONE_LINE = (  # the elbow's offset comes back behind it, so that both rolls are on one line at 0
    ("0.0508 -0.1524 0.3048", "1.8326 0 0.2618"),
    ("0 0 -0.0508", "-1.5708 0 0"),
    ("0 0.3048 0", "1.5708 0 0"),
    ("0.0254 0 0", "-1.5708 0 0"),
    ("-0.0254 0.3683 0", "1.5708 0 0"),
    ("0 0 0", "-1.5708 -1.5708 0"),
)


def test_solutions_on_a_curve_that_starts_lead_astray_from_are_found(tmp_path: Path) -> None:
    """The closed form begins beside the place where another curve nearly crosses it."""
    tool = ("0.0222 0.07 0", "1.5708 0 0")
    path = serial_urdf(tmp_path / "wrist.urdf", ROLLS_ON_ONE_LINE, tip=tool, limit=3.1)
    q = np.random.default_rng(7).uniform(-3.1, 3.1, (120, 6))
    q[:, 3] = 0.0
    arm, header = emitted_in_both(Request(path, name="wrist"), tmp_path)
    found = (gaps_in_both(arm, header, q) < 1e-3).sum(axis=1)
    assert found[0] >= 112 and found[1] >= 117, found  # rows begun aside: 97 and 99 without
