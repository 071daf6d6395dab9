"""Operations as text of each language: numbers, precedence, calls."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from ikgen.emit.cpp import cpp_language
from ikgen.emit.cpp.cpp_language import CONSTANT, CPP, comment, declared, literal
from ikgen.emit.nanobind import _version
from ikgen.emit.printer import Language, expression
from ikgen.emit.python import python_language
from ikgen.emit.python.import_lines import External, import_lines
from ikgen.emit.python.python_language import BATCH, SCALAR
from ikgen.program.interpret import evaluate
from ikgen.program.ops import Op, Operand

VALUES = {"a": 0.75, "b": -1.25, "c": 2.5}
A, B, C = VALUES
GREATER, LESS = Op("gt", (A, B)), Op("gt", (B, C))
ARITHMETIC = [
    Op(outer, (Op(inner, (A, B)), C) if left else (C, Op(inner, (A, B))))
    for outer, inner in itertools.product(("add", "sub", "mul", "div"), repeat=2)
    for left in (True, False)
]
SIGNS = [
    Op("neg", (Op("add", (A, B)),)), Op("neg", (Op("mul", (A, B)),)), Op("sub", (A, Op("neg", (B,)))),
    Op("neg", (Op("neg", (A,)),)), Op("sub", (A, -0.5)), Op("mul", (-0.5, Op("neg", (A,)))),
    Op("add", (A, Op("add", (B, C)))), Op("neg", (-2.0,)),
]  # fmt: skip
CALLS = [
    Op("sqrt", (Op("mul", (C, C)),)), Op("sqrt", (C,)), Op("sqrt", (B,)), Op("abs", (B,)),
    Op("max", (A, B)), Op("min", (A, B)), Op("cos", (A,)), Op("sin", (A,)), Op("atan2", (A, B)),
    Op("select", (GREATER, A, C)), Op("select", (LESS, A, C)),
]  # fmt: skip
CONDITIONS = [
    GREATER, LESS, Op("not", (GREATER,)), Op("not", (Op("and", (GREATER, LESS)),)),
    *(Op(op, pair) for op in ("and", "or") for pair in itertools.product((GREATER, LESS), repeat=2)),
    Op("and", (Op("or", (LESS, GREATER)), LESS)), Op("or", (Op("and", (LESS, GREATER)), GREATER)),
    Op("and", (Op("not", (LESS,)), GREATER)), Op("gt", (Op("add", (A, B)), Op("sub", (B, A)))),
]  # fmt: skip


@pytest.mark.parametrize("operand", [*ARITHMETIC, *SIGNS, *CALLS, *CONDITIONS], ids=str)
def test_python_text_has_the_operand_s_value(operand: Operand) -> None:
    wanted = evaluate(operand, VALUES)
    names = {"sqrt": math.sqrt, "cos": math.cos, "sin": math.sin, "atan2": math.atan2, "np": np}
    assert eval(expression(SCALAR, operand), {**names, **VALUES}) == wanted
    arrays = {name: np.array([value]) for name, value in VALUES.items()}
    found = eval(expression(BATCH, operand), {"np": np, **arrays})
    assert np.ravel(found)[0] == wanted


def c_value(text: str) -> float:
    """The value of C++ text whose operators mean the same in Python."""
    text = text.replace("&&", " and ").replace("||", " or ").replace("!", " not ")
    names = {
        "select": lambda c, x, y: x if c else y, "angle": math.atan2, "max": max, "min": min, "abs": abs,
        "sqrt": lambda x: math.sqrt(max(x, 0.0)),
    }  # fmt: skip
    return float(eval(text.replace("std::", "").replace("<double>", ""), {**names, **VALUES}))


@pytest.mark.parametrize("operand", [*ARITHMETIC, *SIGNS], ids=str)
def test_cpp_text_groups_as_the_operand_does(operand: Operand) -> None:
    for language in (CPP, CONSTANT):
        text = expression(language, operand)
        assert "--" not in text and c_value(text) == evaluate(operand, VALUES)


@pytest.mark.parametrize("operand", CONDITIONS, ids=str)
def test_cpp_conditions_hold_where_the_operand_does(operand: Operand) -> None:
    """In C++ `&` and `|` bind less than a comparison, unlike in Python: what stands between is in
    parentheses or a comparison."""
    text = expression(CPP, operand, 3)
    assert text.isidentifier() or text.startswith(("(", "!("))
    python = text.replace("!", " not ").replace("&", " and ").replace("|", " or ")
    assert float(bool(c_value(python))) == evaluate(operand, VALUES)


def test_cpp_calls() -> None:
    for operand in CALLS[:6]:
        assert c_value(expression(CPP, operand)) == evaluate(operand, VALUES)
        assert c_value(expression(CONSTANT, operand)) == evaluate(operand, VALUES)
    assert expression(CPP, Op("atan2", (A, B))) == "angle(a, b)"
    assert expression(CPP, Op("spread", (A,))) == "spread<1>(a)"
    assert expression(CPP, Op("select", (GREATER, A, 1.0))) == "select(a > b, a, 1.0)"
    assert expression(CONSTANT, Op("select", (GREATER, A, 1.0))) == "(a > b ? a : 1.0)"
    assert expression(CPP, Op("and", (GREATER, LESS))) == "(a > b) & (b > c)"  # as compilers ask
    assert expression(CPP, Op("or", ("x", "y"))) == "(x | y)"
    assert expression(CPP, Op("or", (GREATER, Op("or", ("x", "y"))))) == "((a > b) | (x | y))"
    assert expression(CPP, Op("and", (Op("and", ("x", "y")), "z"))) == "x & y & z"
    assert expression(CPP, Op("and", ("x", "y")), 3) == "(x & y)"  # behind another &
    assert expression(CONSTANT, Op("and", ("x", "y"))) == "x && y"
    assert expression(CONSTANT, Op("or", ("x", "y"))) == "(x || y)"


@pytest.mark.parametrize(
    "value", [0.0, -0.0, 1.0, -2.5, 1e-300, 0.1, 3, math.inf, -math.inf, math.nan]
)
def test_numbers_read_back_to_the_same_bits(value: float) -> None:
    found = eval(python_language.number(value), {"inf": math.inf, "nan": math.nan})
    assert repr(found) == repr(float(value))
    text = cpp_language.number(value)
    limits = "std::numeric_limits<double>::"
    wanted = {
        "inf": f"{limits}infinity()", "-inf": f"-{limits}infinity()", "nan": f"{limits}quiet_NaN()",
    }  # fmt: skip
    assert text == wanted.get(repr(float(value)), repr(float(value)))


def test_a_number_is_in_parentheses_where_its_sign_would_join() -> None:
    plain = Language({"add": ("+", 5)}, {}, {}, repr)
    assert expression(plain, -1.0) == "-1.0" and expression(plain, 1.0) == "1.0"
    assert expression(plain, Op("add", (-1.0, -2.0))) == "(-1.0) + (-2.0)"


def test_texts_in_cpp_are_no_code() -> None:
    assert literal('a"b\\c?') == '"a\\042b\\134c\\077"' and literal("é") == '"\\303\\251"'
    assert literal(" ~!") == '" ~!"' and literal("\x7f\x1f") == '"\\177\\037"'
    assert comment("a\\\nb\u2028c d") == "a??b?c d"
    assert declared("int", []) == []
    assert declared("int", [("a", "1"), ("b", "2")]) == ["int a = 1, b = 2;"]
    lines = declared("double", [(f"name_{k}", "0.123456789") for k in range(12)])
    assert len(lines) > 1 and max(map(len, lines)) <= 110
    assert all(line.startswith("    ") for line in lines[1:])
    assert " ".join(" ".join(lines).split()).count("= 0.123456789") == 12


@pytest.mark.parametrize(
    ("generator", "version"),
    [("1.2.3", "1.2.3"), ("1.2.3.dev4", "1.2.3.dev4"), ("2", "2"), ("1.0rc1", "1.0rc1"),
     ("1.2+local", "0"), ("x1.2", "0"), ("", "0")],
)  # fmt: skip
def test_versions_of_packages(generator: str, version: str) -> None:
    assert _version(generator) == version


def test_imports_bind_a_name() -> None:
    assert External("a.b", "", "").binds == "a" and External("a.b", "", "c").binds == "c"
    assert External("a", "f", "").binds == "f" and External("a", "f", "g").binds == "g"


def test_imports_are_in_three_groups_and_wrapped() -> None:
    names = [External("pkg.module", f"name_{k}", "") for k in range(12)]
    found = import_lines([
        External("numpy", "", "np"), External("math", "pi", ""), External("math", "ABC", ""),
        External("math", "Class", ""), External("math", "pi", ""), External("os.path", "", ""),
        External("__future__", "annotations", ""), External("pkg", "f", "_f"), *names,
    ])  # fmt: skip
    assert found[:7] == [
        "from __future__ import annotations", "", "import os.path",
        "from math import ABC, Class, pi", "", "import numpy as np", "from pkg import f as _f",
    ]  # fmt: skip
    assert found[7] == "from pkg.module import (" and found[-1] == ")" and len(found) == 8 + 12 + 1
    assert sorted(found[8:-1]) == sorted(f"    name_{k}," for k in range(12))
    assert import_lines([]) == [] and import_lines(names[:1]) == ["from pkg.module import name_0"]
