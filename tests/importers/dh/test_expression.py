"""Expressions of xacro files: as Python computes them, and nothing beyond computing."""

from __future__ import annotations

import math
import time

import pytest
import xacro
from hypothesis import given
from hypothesis import strategies as st

from ikgen.importers.xacro import budget as budgets
from ikgen.importers.xacro.budget import Budget
from ikgen.importers.xacro.macro_expression import Evaluator
from ikgen.importers.xacro.refusals import ExpansionLimitError, RefusedExpressionError
from ikgen.importers.xacro.symbol_table import global_symbols


@pytest.fixture(scope="module")
def symbols():
    return global_symbols(xacro, lambda name: {"name": name})


@pytest.fixture
def evaluate(symbols):
    def evaluate(text, **names):
        return Evaluator(Budget()).evaluate(text, {**symbols, **names})

    return evaluate


OPERATORS = ["+", "-", "*", "/", "//", "%", "<", "=="]
SAME_AS_PYTHON = [
    "1 + 2 * 3 - 4 / 5 // 6 % 7 ** 2",
    "-1 + +2 + ~3",
    "1 << 4 | 3 & 6 ^ 1 >> 0",
    "1 < 2 <= 2 != 3 == 3 > 1 >= 0",
    "1 in [1, 2] and 3 not in (1, 2)",
    "None is None and None is not None",
    "0 or [] or 'last'",
    "1 and '' and 2",
    "not 1",
    "2 if 1 > 2 else 3",
    "[1, *[2, 3]] + [4][:1]",
    "(1, 2)[-1]",
    "{'a': 1, **{'b': 2}}['b']",
    "{1, 2} | {3}",
    "'abc'[::-1]",
    "'%02d_%.3f' % (3, 0.5)",
    "'_'.join(['a', 'b']).upper()",
    "'a,b'.split(',')[1].replace('b', 'c').zfill(3)",
    "[a * b for a, b in [(1, 2), (3, 4)] if a > 1]",
    "{k: v for k, v in {'a': 1}.items()}",
    "[(a, b) for a in range(3) for b in range(a) if b]",
    "sorted({3, 1, 2}, reverse=True)",
    "list(map(str, [1, 2]))",
    "max(1, 2), min([3, 4]), len('abc'), round(2.567, 2)",
    "dict(a=1, **{'b': 2})",
    "str(1.0) + str(True) + str([1])",
    "int('12') + float('1.5') + bool(0)",
    "1e308 * 10",
    "10 ** -3",
    "2 ** 0.5",
    "1_000",
]


@pytest.mark.parametrize("text", SAME_AS_PYTHON)
def test_values_are_pythons(evaluate, text):
    assert evaluate(text) == eval(text)


@given(
    st.recursive(
        st.integers(0, 50).map(str) | st.floats(0, 10).map(repr),
        lambda inner: st.tuples(inner, st.sampled_from(OPERATORS), inner).map(
            lambda parts: f"({parts[0]} {parts[1]} {parts[2]})"
        ),
        max_leaves=12,
    )
)
def test_arithmetic_is_pythons(text):
    def outcome(compute):
        try:
            return repr(compute())
        except ZeroDivisionError as error:
            return str(error)

    assert outcome(lambda: Evaluator(Budget()).evaluate(text, {})) == outcome(lambda: eval(text))


def test_names_of_xacro(evaluate):
    assert evaluate("radians(180) + math.pi + pi") == 3 * math.pi
    assert evaluate("python.sum(python.map(abs_, [-1, 2]))", abs_=abs) == 3
    assert evaluate("python.zip([1], ['a'])") == [(1, "a")]
    assert evaluate("xacro.dotify(d).inner.x", d={"inner": {"x": 7}}) == 7
    assert evaluate("xacro.tokenize('a, b;c')") == ["a", "b", "c"]
    assert evaluate("xacro.load_yaml('f')") == {"name": "f"}


def test_all_of_xacros_names_are_known_but_two(symbols):
    original = xacro.create_global_symbols()
    assert set(original) == set(symbols)
    left_out = {
        f"{space}.{name}"
        for space in ("math", "python", "xacro")
        for name in set(original[space]) - set(symbols[space])
    }
    assert left_out == {"python.vars", "python.hash"}


def test_methods_of_dictionaries_go_before_their_entries(evaluate):
    data = xacro.YamlDictWrapper({"joint_limits": {"low": 1}, "items": 2})
    assert evaluate("d.joint_limits.low + len(d.items())", d=data) == 3
    with pytest.raises(AttributeError, match="no key 'absent'"):
        evaluate("d.absent", d=data)


REACHES_OUT = [
    "().__class__",
    "(lambda: 1)()",
    "[s for s in ().__class__.__base__.__subclasses__()]",
    "[x for x in [1] if x.__class__]",
    "{x.__class__: 1 for x in [1]}",
    "'{0.__class__}'.format(1)",
    "'a'.format_map({})",
    "str.format('{0.__class__}', 1)",
    "map(str.format, ['{0.__class__}'])",
    "f'{1}'",
    "f'{(1).__class__}'",
    "(x for x in [1]).gi_frame",
    "math.__loader__",
    "xacro.load_yaml.__globals__",
    "xacro._private",
    "python.type(1).mro()",
    "dict.fromkeys([1])",
    "int.from_bytes",
    "[1].append(2)",
    "__import__('os')",
    "__builtins__",
    "(y := 1)",
    "await_ if (yield 1) else 2",
    "b'bytes'",
    "...",
    "[x async for x in [1]]",
    "1 @ 2",
    "[1 for [].x in [1]]",
]


@pytest.mark.parametrize("text", REACHES_OUT)
def test_what_reaches_out_of_the_values_is_refused(evaluate, text):
    with pytest.raises(RefusedExpressionError) as caught:
        evaluate(text)
    assert caught.value.expression == text


@pytest.mark.parametrize("name", ["eval", "exec", "open", "getattr", "vars", "object", "print"])
def test_other_names_of_python_are_unknown(evaluate, name):
    with pytest.raises(NameError, match=name):
        evaluate(f"{name}(1)")


GROWS = [
    "9**9**9",
    "(10**1000)**1000",
    "1 << 10**10",
    "python.sum(python.range(10**11))",
    "'a' * 10**10",
    "10**9 * [0]",
    "(1, 2) * 10**8",
    "'%1000000000d' % 1",
    "'%*d' % (10**9, 1)",
    "'%(a)s' % {'a': 1}",
    "'a'.ljust(10**10)",
    "('a' * 10**5).replace('a', 'b' * 10**5)",
    "('a' * 10**5).join(['b'] * 10**4)",
    "factorial(10**7)",
    "math.comb(10**7, 5 * 10**6)",
    "math.perm(10**7)",
    "math.prod([10**1000] * 1000)",
    "math.lcm(10**600 + 1, 10**600 + 3, 10**600 + 7)",
    "round(10**1000, -10**9)",
    "python.map(python.list, python.map(range, range(10**4)))",
    "[[x] * 1000 for x in range(10000)]",
    "python.sum([[0] * 1000] * 1000, [])",
    "-" * 9000 + "1",
    "+".join(["1"] * 4000),
    "1 +" * 10_000 + "1",
]


@pytest.mark.parametrize("text", GROWS)
def test_what_grows_without_bounds_is_refused_at_once(evaluate, text):
    started = time.process_time()
    with pytest.raises(RefusedExpressionError):
        evaluate(text)
    assert time.process_time() - started < 2.0


@pytest.mark.parametrize(
    "text",
    [
        "[1 for a in range(10000) for b in range(10000) if 0]",
        "python.sum([0 for a in range(1000) for b in range(1000) for c in range(1000) if 0])",
    ],
)
def test_what_goes_on_for_ever_ends_when_its_time_is_up(evaluate, monkeypatch, text):
    monkeypatch.setattr(budgets, "MOST_SECONDS", 0.2)
    with pytest.raises(ExpansionLimitError, match=r"more than 0\.2 s"):
        evaluate(text)


def test_a_separator_is_no_pattern(evaluate):
    started = time.process_time()
    assert evaluate("xacro.tokenize('x' + 'a' * 40, sep='](a+)+[')") != []
    assert time.process_time() - started < 1.0
