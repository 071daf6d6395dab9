"""DH tables: conventions, names, merged rows, and refusals that say what to do."""

from __future__ import annotations

import math
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from ikgen.errors import BadDescriptionError, UnknownNameError
from ikgen.importers.dh.dh_table import read_dh_table
from ikgen.kinematics.forward import dh_forward, file_forward
from ikgen.model.dh import DHChain

FIXTURES = Path(__file__).resolve().parents[3] / "urdf_fixtures"
ROW = ("type", "alpha", "a", "d", "theta")


def table(
    rows: list[tuple[object, ...]], head: str = 'convention = "modified"', tail: str = ""
) -> str:
    """A TOML table; each row is (type, alpha, a, d, theta)."""
    parts = [head]
    for row in rows:
        values = [f'"{x}"' if isinstance(x, str) else repr(x) for x in row]
        parts.append("[[joints]]")
        parts += [f"{k} = {v}" for k, v in zip(ROW, values, strict=True)]
    return "\n".join([*parts, tail])


def read(tmp_path: Path, text: str, **options: object) -> DHChain:
    path = tmp_path / "arm.toml"
    path.write_text(text)
    return read_dh_table(path, **options)[1]  # type: ignore[arg-type]


def rx(t: float) -> np.ndarray:
    c, s = math.cos(t), math.sin(t)
    return np.array([[1, 0, 0, 0], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1.0]])


def rz(t: float) -> np.ndarray:
    c, s = math.cos(t), math.sin(t)
    return np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]])


def shift(x: float, z: float) -> np.ndarray:
    T = np.eye(4)
    T[0, 3], T[2, 3] = x, z
    return T


def product(
    rows: list[tuple[str, float, float, float, float]], q: np.ndarray, standard: bool
) -> np.ndarray:
    """The table's forward kinematics, written down as its convention says."""
    T, k = np.eye(4), 0
    for kind, alpha, a, d, theta in rows:
        if kind != "fixed":
            theta, d = (theta + q[k], d) if kind == "revolute" else (theta, d + q[k])
            k += 1
        link, screw = rx(alpha) @ shift(a, 0), rz(theta) @ shift(0, d)
        T = T @ (screw @ link if standard else link @ screw)
    return T


R, P, F = "revolute", "prismatic", "fixed"
CASES = {
    "plain": [(R, 0, 0, 0.3, 0), (R, -1.5, 0.2, 0, 0.4), (P, 0.7, 0.1, 0.2, 0.3)],
    "ends fixed": [
        (F, 0.3, 0.1, 0.2, 0.5), (R, 0, 0, 0.3, 0), (R, 1.0, 0.2, 0, 0), (F, 0.1, 1, 2, 3),
    ],
    "fixed link": [(R, 0, 0, 0.3, 0), (F, 0.5, 0.1, 0, 0), (R, 1.0, 0.2, 0, 0)],
    "fixed screw": [(R, 0, 0, 0.3, 0), (F, 0, 0, 0.4, 0.6), (R, 1.0, 0.2, 0, 0)],
    "fixed shift": [(R, 0, 0, 0.3, 0), (F, 0, 0.3, 0.4, 0), (R, 1.0, 0.2, 0, 0)],
    "fixed half turn": [(R, 0, 0, 0.3, 0), (F, 0.3, 0.3, 0, math.pi), (R, 1.0, 0.2, 0, 0)],
    "fixed, then parallel": [(R, 0, 0, 0.3, 0), (F, 0.3, 0.3, 0.4, 0), (P, 0, 0.2, 0.1, 0.2)],
    "fixed, not exact": [(R, 0, 0, 0.3, 0), (F, 0.3, 0.3, 0.4, 0.8), (R, 0.5, 0.2, 0.1, 0.2)],
    "two fixed": [(R, 0, 0, 0, 0), (F, 0.3, 0.3, 0, 0), (F, 0.2, 0.1, 0, 0), (R, 1, 0, 0, 0)],
    "antiparallel": [
        (R, 0, 0, 0.3, 0), (R, math.pi, 0.2, 0.1, 0.4), (P, 0.6, 0.1, 0.2, 0.3),
        (R, math.pi, 1, 2, 0.1),
    ],
}  # fmt: skip


@pytest.mark.parametrize("convention", ["modified", "standard"])
@pytest.mark.parametrize("name", CASES)
def test_forward_is_the_tables(tmp_path: Path, name: str, convention: str) -> None:
    dh = read(tmp_path, table(CASES[name], f'convention = "{convention}"'))
    rng = np.random.default_rng(1)
    for q in rng.uniform(-2, 2, (5, dh.dof)):
        expected = product(CASES[name], q, convention == "standard")  # type: ignore[arg-type]
        np.testing.assert_allclose(dh_forward(dh, q), expected, atol=1e-12)
        np.testing.assert_allclose(file_forward(dh, q), expected, atol=1e-12)
    assert all(row.alpha.exact != 1 for row in dh.rows[1:])


def test_standard_puma_is_the_modified_one(tmp_path: Path) -> None:
    modified = [
        (R, 0, 0, 0, 0),
        (R, "-pi/2", 0, 0, 0),
        (R, 0, "a_2", "d_3", 0),
        (R, "-pi/2", "a_3", "d_4", 0),
    ]
    standard = [
        (R, "-pi/2", 0, 0, 0),
        (R, 0, "a_2", 0, 0),
        (R, "-pi/2", "a_3", "d_3", 0),
        (R, 0, 0, "d_4", 0),
    ]
    one = read(tmp_path, table(modified))  # type: ignore[arg-type]
    two = read(tmp_path, table(standard, 'convention = "standard"'))  # type: ignore[arg-type]
    assert one.rows == two.rows
    np.testing.assert_array_equal(one.X_tip, two.X_tip)


def test_names_are_the_users(tmp_path: Path) -> None:
    rows = [
        (R, 0, 0, "h", 0),
        (R, "al_1", "-l_3", 0, 0),
        (R, 0, "l_3", 0, 0),
        (R, 0, "l_1+l_2", "l1", 0),
    ]
    head = (
        'convention = "modified"\n[parameters]\nh = 1.0\nl_3 = -2.0\nl_1 = 0.25\nl_2 = 0.5\nl1 = 3'
    )
    dh = read(tmp_path, table(rows, head))  # type: ignore[arg-type]
    one, two, three, four = dh.rows
    assert one.d.name == "h_"
    assert (two.a.name, two.a.sign, two.a.value) == ("l_3", -1, 2.0)
    assert (three.a.name, three.a.sign, three.a.value) == ("l_3", 1, -2.0)
    assert four.a.value == 0.75
    assert four.a.name == "a_3"
    assert four.d.name == "l_1_"
    assert two.alpha.name == "al_1" and two.alpha.symbolic and two.alpha.exact is None
    assert dh.symbols == ("al_1",)


def test_symbols_take_the_same_generic_value(tmp_path: Path) -> None:
    rows = [(R, 0, 0, 0, 0), (R, "pi/2", "a_1", 0, 0), (P, "-pi/2", "a_1 + d_9", 0, 0)]
    one, two = (read(tmp_path, table(rows)) for _ in range(2))  # type: ignore[arg-type]
    assert one.rows == two.rows
    assert one.symbols == ("a_1", "a_2")
    assert one.rows[1].alpha.exact == Fraction(1, 2)
    assert one.rows[2].a.value != one.rows[1].a.value


def test_variable_written_as_its_own_entry_is_no_offset(tmp_path: Path) -> None:
    dh = read(tmp_path, table([(R, 0, 0, 0, "theta_1 + pi/2"), (P, 0, 0, "d_2", 0)]))
    assert dh.rows[0].offset.value == pytest.approx(math.pi / 2)
    assert dh.rows[1].offset.value == 0.0
    assert dh.symbols == ()


def test_rounded_right_angles_become_exact_and_are_told(tmp_path: Path) -> None:
    dh = read(tmp_path, table([(R, 0, 0, 0, 0), (R, 1.5708, 0, 0.3, 0), (R, -1.57, 0.4, 0, 0)]))
    assert [row.alpha.exact for row in dh.rows] == [0, Fraction(1, 2), Fraction(-1, 2)]
    assert len(dh.snaps) == 2
    assert dh.deviation[1] == pytest.approx(8e-4, rel=0.1)


def test_locked_joints_become_constants(tmp_path: Path) -> None:
    rows = [(R, 0, 0, 0.1, 0), (R, 1.0, 0.2, 0.3, 0.1), (P, 0, 0.5, 0, 0.4)]
    text = table(rows)  # type: ignore[arg-type]
    whole, part = read(tmp_path, text), read(tmp_path, text, locked={"theta_2": 0.7})
    assert [j.name for j in part.joints] == ["theta_1", "d_3"]
    assert part.locked == (("theta_2", 0.7),)
    for q in np.random.default_rng(0).uniform(-1, 1, (3, 2)):
        np.testing.assert_allclose(
            dh_forward(part, q), dh_forward(whole, [q[0], 0.7, q[1]]), atol=1e-12
        )


@pytest.mark.parametrize(
    ("limits", "words"),
    [
        ("[-2, 1e9]", "upper limit 1e+09 rad stands for none: taken as 12.5664"),
        ("[-170, 170]", "look like degrees"),
        ("[-1e9, 1e9]", ""),
    ],
)
def test_limits_that_are_hardly_meant(tmp_path: Path, limits: str, words: str) -> None:
    path = tmp_path / "arm.toml"
    path.write_text(table(GOOD, tail=f"limits = {limits}"))
    source, dh = read_dh_table(path)
    assert " ".join(source.warnings).endswith(words + ": kept as they are" * ("degrees" in words))
    upper = dh.joints[-1].limits.upper
    assert upper == (math.inf if not words else 170.0 if "degrees" in words else 4.0 * math.pi)


def test_limits_with_units(tmp_path: Path) -> None:
    rows = [(R, 0, 0, 0.3, 0), (P, 0.7, 0.1, 0.2, 0.3)]
    head, tail = table(rows[:1], tail='limits = ["-150deg", "pi/2"]'), 'limits = ["-5 mm", "20cm"]'
    dh = read(tmp_path, head + table(rows[1:], head="", tail=tail))
    found = [(joint.limits.lower, joint.limits.upper) for joint in dh.joints]
    assert found == [(math.radians(-150.0), math.pi / 2.0), (-0.005, 0.2)]


def test_standard_fixture_with_limits_and_tool() -> None:
    source, dh = read_dh_table(FIXTURES / "scara_standard.toml", free=("flange",))
    assert source.warnings == ()
    assert source.kind == "dh-table"
    assert [j.name for j in dh.joints] == ["shoulder", "elbow", "quill", "flange"]
    assert dh.joints[0].limits.upper == pytest.approx(3 * math.pi / 4)
    assert dh.free == ("flange",)
    assert (dh.base_link, dh.tip_link) == ("base", "gripper")
    T = dh_forward(dh, [0.0, 0.0, 0.0, 0.0])
    np.testing.assert_allclose(T[:3, 3], [0.55, 0.0, 0.4 - 0.1 - 0.05], atol=1e-12)


def test_redundant_axes_are_told(tmp_path: Path) -> None:
    path = tmp_path / "arm.toml"
    path.write_text(
        table([(R, 0, 0, 0, 0), (R, 0, 0, 1, 0), (P, 1.0, 0, 0, 0), (P, "pi", 1, 0, 0)])
    )
    source, _ = read_dh_table(path)
    assert "'theta_1' and 'theta_2'" in source.warnings[0]
    assert "'d_3' and 'd_4'" in source.warnings[1]
    held, _ = read_dh_table(path, free=("theta_2", "d_3"))
    assert not held.warnings


def test_other_convention_is_pointed_out(tmp_path: Path) -> None:
    path = tmp_path / "arm.toml"
    rows = [(R, "-pi/2", 0, 0, 0), (R, 0, 1, 0, 0), (R, 0, 0, 0, 0)]
    path.write_text(table(rows))
    assert "looks like the standard convention" in read_dh_table(path)[0].warnings[0]
    path.write_text(table(rows[::-1], 'convention = "standard"'))
    assert "looks like the modified convention" in read_dh_table(path)[0].warnings[0]


GOOD = [(R, 0, 0, 0, 0), (R, "-pi/2", 0, 0, 0)]
BAD = {
    "syntax": ("convention = modified", "TOML", "modified"),
    "convention missing": (table(GOOD, 'name = "x"'), "no convention", None),
    "convention unknown": (table(GOOD, 'convention = "craig"'), "craig", "convention"),
    "no joints": ('convention = "modified"', "no joints", None),
    "unknown key": (table(GOOD, tail="lenght = 1"), "joint 2: unknown key 'lenght'", "lenght"),
    "unknown top key": (
        table(GOOD, 'convention = "modified"\nparam = 1'), "unknown key 'param'", "param",
    ),
    "no type": ('convention = "modified"\n[[joints]]\na = 1', "joint 1: no type", "joints"),
    "missing": (
        'convention = "modified"\n[[joints]]\ntype = "revolute"\na = 1\nd = 0',
        "without 'alpha'", "joints",
    ),
    "expression": (
        table([*GOOD, (R, "pi/", 0, 0, 0)]), "joint 3: alpha: 'pi/' is not an expression", "pi/",
    ),
    "function": (table([*GOOD, (R, "sin(1)", 0, 0, 0)]), "'sin' is no function", "sin"),
    "attribute": (table([*GOOD, (R, "pi.real", 0, 0, 0)]), "not allowed", "real"),
    "call": (table([*GOOD, (R, 0, "__import__('os')", 0, 0)]), "no function", "import"),
    "zero": (table([*GOOD, (R, 0, "1/0", 0, 0)]), "divides by zero", "1/0"),
    "wrong type": (
        table([*GOOD, (R, 0, True, 0, 0)]).replace("True", "true"), "neither a number", "true",
    ),
    "misspelt": (
        table([*GOOD, (R, 0, "a2", 0, 0)], 'convention = "modified"\n[parameters]\na_2 = 1'),
        "no parameter named 'a2'", "a2",
    ),
    "offset symbol": (table([(R, 0, 0, 0, "x_1")]), "has no number", "x_1"),
    "parameter text": (
        table(GOOD, 'convention = "modified"\n[parameters]\nb = "c + 1"'),
        "'b' has no number", "c + 1",
    ),
    "limits order": (table(GOOD, tail="limits = [2, 1]"), "above", "limits"),
    "limits unit": (table(GOOD, tail='limits = ["-10deg", "2cm"]'), "'2cm' is no value of a", "limits"),
    "limits count": (table(GOOD, tail="limits = [2]"), "not two numbers", "limits"),
    "same name": (
        table([(R, 0, 0, 0, 0)], tail='name = "a"\n' + table(GOOD[1:], "", 'name = "a"')),
        "joint 1's already", "name",
    ),
    "tool": (table(GOOD, tail="[tool]\nxyz = [1, 2]"), "not three numbers", "xyz"),
    "all fixed": (table([(F, 0, 0, 0, 0)]), "no joint moves", None),
    "large": (table([*GOOD, (R, 0, 1e308, 0, 0)]), "1e+308 is beyond 10000", "1e+308"),
    "large sum": (table([*GOOD, (R, 0, "1e200 * 1e100", 0, 0)]), "beyond 10000", "1e200"),
    "large integer": (table([*GOOD, (R, 0, 10**400, 0, 0)]), "inf is beyond", "0000"),
    "digits": (table([*GOOD, (R, 0, "@", 0, 0)]).replace('"@"', "9" * 5000), "TOML", None),
    "long": (table([*GOOD, (R, 0, "1+" * 5000 + "1", 0, 0)]), "of 10001 characters", "1+1"),
    "infinite": (table([*GOOD, (R, 0, "@", 0, 0)]).replace('"@"', "inf"), "inf is beyond", "inf"),
    "large parameter": (
        table(GOOD, 'convention = "modified"\n[parameters]\nb = 1' + "0" * 400), "too large", "b =",
    ),
    "limits far out": (table(GOOD, tail="limits = [1e15, 1e16]"), "hold no value", "limits"),
    "large tool": (table(GOOD, tail="[tool]\nxyz = [1e9, 0, 0]"), "beyond 10000", "xyz"),
    "many joints": (table([(R, "pi/2", 0.1, 0, 0)] * 17), "17 joints move, more than 16", None),
    "many rows": (table([(F, 0, 0.1, 0, 0)] * 101), "101 rows, more than 100", None),
}  # fmt: skip


@pytest.mark.parametrize("name", BAD)
def test_refusals_say_what_and_where(tmp_path: Path, name: str) -> None:
    text, message, line = BAD[name]
    with pytest.raises(BadDescriptionError) as caught:
        read(tmp_path, text)
    assert message in caught.value.message
    assert "arm.toml" in caught.value.message
    assert caught.value.hint
    if line is not None:
        assert caught.value.line
        assert line in text.splitlines()[caught.value.line - 1]


def test_unknown_joints_are_listed(tmp_path: Path) -> None:
    with pytest.raises(UnknownNameError, match="theta_9"):
        read(tmp_path, table(GOOD), free=("theta_9",))
    with pytest.raises(BadDescriptionError, match="no such file"):
        read_dh_table(tmp_path / "none.toml")


def test_names_without_numbers_are_told_with_those_of_the_code(tmp_path: Path) -> None:
    row = '[[joints]]\ntype = "revolute"\nalpha = 0\na = "{}"\nd = 0\ntheta = 0\n'
    rows = "".join(row.format(name) for name in ("a1", "a2", "l_3", "dt", "0"))
    path = tmp_path / "arm.toml"
    path.write_text(f'name = "arm"\nconvention = "standard"\n[parameters]\na1 = 0.3\n{rows}')
    source, dh = read_dh_table(path)
    (said,) = (w for w in source.warnings if "symbols" in w)
    words = "kept as symbols, without numbers: a2 (a_2 in code), dt (dt_ in code), l_3"
    assert said == f"{path}: {words}" and set(dh.symbols) == {"a_2", "dt_", "l_3"}


def test_a_name_without_a_number_is_a_length_or_an_angle(tmp_path: Path) -> None:
    row = '[[joints]]\ntype = "revolute"\nalpha = {}\na = 0\nd = {}\ntheta = 0\n'
    rows = row.format(0, '"-beta"') + row.format('"beta"', 0)
    path = tmp_path / "arm.toml"
    path.write_text(f'name = "arm"\nconvention = "standard"\n{rows}')
    with pytest.raises(BadDescriptionError) as caught:
        read_dh_table(path)
    assert "'beta' is an angle here, and a length in row 1 ('d')" in caught.value.message
    assert caught.value.line == path.read_text().splitlines().index('alpha = "beta"') + 1
    path.write_text(f'name = "arm"\nconvention = "standard"\n[parameters]\nbeta = 0.3\n{rows}')
    assert [one.name for one in read_dh_table(path)[1].joints] == ["theta_1", "theta_2"]


def test_degrees_and_millimetres_are_told(tmp_path: Path) -> None:
    path = tmp_path / "table.toml"
    rows = [("0", "0"), ("-90", "431.8"), ("0", "20.3"), ("pi/2", "0")]
    table = "\n".join(
        f'[[joints]]\nname = "j{i}"\ntype = "revolute"\nalpha = "{alpha}"\na = "{a}"\nd = "0"\n'
        for i, (alpha, a) in enumerate(rows)
    )
    path.write_text(f'convention = "modified"\n{table}')
    found = [str(one) for one in read_dh_table(path)[0].warnings]
    assert any("joint 2: alpha = -90 looks like degrees: taken as rad" in one for one in found)
    assert any("lengths up to 431.8 m look like mm or cm: kept as they are" in one for one in found)
    path.write_text(f'convention = "modified"\n{table}'.replace("431.8", "43.18"))
    found = [str(one) for one in read_dh_table(path)[0].warnings]
    assert any("lengths up to 43.18 m look like mm or cm" in one for one in found)
    path.write_text(
        f'convention = "modified"\n{table}'.replace("431.8", "4e-4").replace("20.3", "0")
    )
    found = [str(one) for one in read_dh_table(path)[0].warnings]
    assert any(
        "lengths add up to 0.4 mm: kept as they are, but are they in m?" in one for one in found
    )
    path.write_text(f'convention = "modified"\n{table}'.replace("431.8", "0.4").replace("-90", "1"))
    assert not any("lengths" in str(one) for one in read_dh_table(path)[0].warnings)
    assert not any("look" in str(one) for one in read_dh_table(path)[0].warnings)


def test_a_single_length_in_millimetres_is_named(tmp_path: Path) -> None:
    path = tmp_path / "table.toml"
    path.write_text(
        'convention = "modified"\n'
        + "".join(
            f'[[joints]]\nname = "j{i}"\ntype = "revolute"\nalpha = "0"\na = "{a}"\nd = "{d}"\n'
            for i, (a, d) in enumerate([("0", "0.3"), ("0.4", "0"), ("0.2", "-85"), ("0", "0.1")])
        )
    )
    told = [one for one in map(str, read_dh_table(path)[0].warnings) if "look" in one]
    (only,) = told
    assert only.endswith("joint 3: d = -85 looks like mm, other lengths like m: kept as it is")
