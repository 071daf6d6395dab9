"""Formulas of forms as they are written: which coefficients stand where."""

from __future__ import annotations

import re

import numpy as np
import pytest
from tests.support.probed import given

from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.equations.knowledge import Variable
from ikgen.forms.form import Form
from ikgen.forms.formula import FormulaWriter, linear_combination
from ikgen.forms.linear_form import Linear
from ikgen.forms.pair_form import LinearPair
from ikgen.forms.quadratic_form import Quadratic
from ikgen.forms.quartic_form import TrigQuartic, _self_inversive
from ikgen.forms.sine_cosine_form import SineCosine
from ikgen.forms.tangent_form import Tangent
from ikgen.formulas import mathtext as m
from ikgen.formulas.mathtext import Math
from ikgen.formulas.naming import Abbreviations
from ikgen.formulas.normalizer import Normalizer

NAMES = ("a1", "b1", "c1", "a2", "b2", "c2")


def latex(text: Math | None) -> str:
    assert text is not None
    return "".join(token.latex for token in text.tokens).replace("\\penalty150", "")


def writer(values: dict[str, list[float]]) -> FormulaWriter:
    """Of coefficients with these values at three probes."""
    g = ExpressionGraph(3)
    e = [g.atom("pose", name, np.array(values[name]), unknown=False) for name in NAMES]
    return FormulaWriter(Variable("angle", (1, 0)), e, g, Normalizer(), Abbreviations([]))


PLAIN = {name: [1.0 + k, 2.0 - k, 0.5 * k] for k, name in enumerate(NAMES)}


def test_a_minor_takes_its_four_coefficients() -> None:
    w = writer(PLAIN)
    values = [np.array(PLAIN[name]) for name in NAMES]
    np.testing.assert_allclose(
        w.minor(0, 4, 3, 1).probe, values[0] * values[4] - values[3] * values[1]
    )
    np.testing.assert_allclose(
        w.minor(2, 5, 1, 0).probe, values[2] * values[5] - values[1] * values[0]
    )


def test_unknowns_have_the_numbers_of_their_joints() -> None:
    g = ExpressionGraph(3)
    slide, turn, both = (
        FormulaWriter(Variable(kind, combination), (), g, Normalizer(), Abbreviations([]))
        for kind, combination in (("prismatic", (0, 1)), ("angle", (0, 1)), ("angle", (1, 1)))
    )
    assert latex(slide.length()) == "d_{2}" and latex(turn.length()) == r"\theta_{2}"
    assert latex(both.cosine()) == "c_{12}" and latex(turn.cosine("sin")) == "s_{2}"


def test_a_divisor_that_is_a_constant_is_not_told() -> None:
    w = writer(PLAIN)
    assert w.divisor(w.g.const(2.0)) is None
    assert latex(w.divisor(w.e[0])) == "a_{1}"


@pytest.mark.parametrize(
    ("diagonal", "solution"),
    [
        ([1.0, 2.0, 3.0], r"(a_{1}\,c_{2}-a_{2}\,c_{1},\,b_{2}\,c_{1}-b_{1}\,c_{2})"),
        ([-1.0, -2.0, -3.0], r"(a_{2}\,c_{1}-a_{1}\,c_{2},\,b_{1}\,c_{2}-b_{2}\,c_{1})"),
        ([1e6, 2e6, -1e-7], r"(a_{1}\,c_{2}-a_{2}\,c_{1},\,b_{2}\,c_{1}-b_{1}\,c_{2})"),
        ([-1e6, -2e6, 1e-7], r"(a_{2}\,c_{1}-a_{1}\,c_{2},\,b_{1}\,c_{2}-b_{2}\,c_{1})"),
    ],
)  # fmt: skip
def test_a_pair_leaves_out_a_determinant_of_one_sign(diagonal: list[float], solution: str) -> None:
    """Of one sign but for rounding."""
    nothing = [0.0, 0.0, 0.0]
    w = writer({**PLAIN, "a1": diagonal, "b2": [1.0, 1.0, 1.0], "b1": nothing, "a2": nothing})
    formula = LinearPair(*w.e).formula(w)
    found = latex(formula.branches[0]).replace("\\,\\,", "\\,")
    assert found == rf"\operatorname{{atan2}}{solution}"
    assert [latex(e) for e in formula.equations] == [
        r"a_{1}\,c_{1}+b_{1}\,s_{1}=c_{1}", r"a_{2}\,c_{1}+b_{2}\,s_{1}=c_{2}"
    ]  # fmt: skip
    first, second = ("a_{1}\\,b_{2}", "a_{2}\\,b_{1}")[:: 1 if diagonal[0] > 0 else -1]
    assert sorted(latex(formula.divisor).split("-")) == sorted([first, second])
    assert latex(formula.divisor).startswith(first)


def test_a_pair_divides_by_a_determinant_of_either_sign() -> None:
    nothing = [0.0, 0.0, 0.0]
    w = writer(
        {**PLAIN, "a1": [1.0, -1.0, 2.0], "b2": [1.0, 1.0, 1.0], "b1": nothing, "a2": nothing}
    )
    (branch,) = LinearPair(*w.e).formula(w).branches
    assert latex(branch).count("frac") == 2


def test_the_polynomial_of_a_quartic_reads_the_same_from_both_ends() -> None:
    letters = [m.name(name[0], name[1]) for name in ("a2", "b2", "a1", "b1", "a0")]
    assert latex(_self_inversive(letters)) == (
        r"(a_{2}-i\,b_{2}){z}^{4}+(a_{1}-i\,b_{1}){z}^{3}+2\,a_{0}\,{z}^{2}"
        r"+(a_{1}+i\,b_{1})z+(a_{2}+i\,b_{2})=0"
    )


WRITTEN: list[tuple[type[Form], str, tuple[str, ...], tuple[str, ...], str, str]] = [
    (Linear, "a b", (r"a\,d_{1}=-b",), (r"-\frac{b}{a}",), "", "a"),
    (Linear, "2 b", (r"2\,d_{1}=-b",), (r"-\tfrac{1}{2}\,b",), "", ""),
    (
        Quadratic, "a b c", (r"a\,d_{1}^{2}+b\,d_{1}=-c",),
        (
            r"\frac{-b+\sqrt{{b}^{2}-4\,a\,c}}{2\,a}",
            r"\frac{-b-\sqrt{{b}^{2}-4\,a\,c}}{2\,a}",
        ), r"{b}^{2}-4\,a\,c", "a",
    ),
    (
        Quadratic, "a 0 c", (r"a\,d_{1}^{2}=-c",),
        (r"\sqrt{-\frac{c}{a}}", r"-\sqrt{-\frac{c}{a}}"), r"-\frac{c}{a}", "a",
    ),
    (
        Quadratic, "2 b c", (r"2\,d_{1}^{2}+b\,d_{1}=-c",),
        (
            r"-\tfrac{1}{4}\,b+\sqrt{0.0625\,{b}^{2}-\tfrac{1}{2}\,c}",
            r"-\tfrac{1}{4}\,b-\sqrt{0.0625\,{b}^{2}-\tfrac{1}{2}\,c}",
        ), r"0.0625\,{b}^{2}-\tfrac{1}{2}\,c", "",
    ),
    (
        SineCosine, "a b c", (r"a\,c_{1}+b\,s_{1}=c",),
        tuple(
            rf"\operatorname{{atan2}}(b,\,a){sign}"
            r"\operatorname{atan2}(\sqrt{{a}^{2}+{b}^{2}-{c}^{2}},\,c)"
            for sign in "+-"
        ), r"{a}^{2}+{b}^{2}-{c}^{2}\ge 0", "{a}^{2}+{b}^{2}",
    ),
    (
        SineCosine, "a 0 c", (r"a\,c_{1}=c",),
        tuple(sign + r"\operatorname{acos}\Bigl(\frac{c}{a}\Bigr)" for sign in ("", "-")),
        r"|c|\le |a|", "a",
    ),
    (
        SineCosine, "0 b c", (r"b\,s_{1}=c",),
        tuple(sign + r"\operatorname{asin}\Bigl(\frac{c}{b}\Bigr)" for sign in ("", r"\pi -")),
        r"|c|\le |b|", "b",
    ),
    (
        SineCosine, "2 0 c", (r"2\,c_{1}=c",),
        tuple(sign + r"\operatorname{acos}(\tfrac{1}{2}\,c)" for sign in ("", "-")),
        r"|c|\le 2", "",
    ),
    (
        Tangent, "a b", (r"K\,c_{1}=a", r"K\,s_{1}=b"),
        (r"\operatorname{atan2}(b,\,a)", r"\operatorname{atan2}(-b,\,-a)"), "", "{a}^{2}+{b}^{2}",
    ),
    (
        TrigQuartic, "a b c d f",
        (
            r"a_{2}\,\operatorname{cos}(2\,\theta_{1})+b_{2}\,\operatorname{sin}(2\,\theta_{1})"
            r"+a_{1}\,\operatorname{cos}(\theta_{1})+b_{1}\,\operatorname{sin}(\theta_{1})+a_{0}\,=0",
            "a_{2}=a", "b_{2}=b", "a_{1}=c", "b_{1}=d", "a_{0}=f",
            r"(a_{2}-i\,b_{2}){z}^{4}+(a_{1}-i\,b_{1}){z}^{3}+2\,a_{0}\,{z}^{2}"
            r"+(a_{1}+i\,b_{1})z+(a_{2}+i\,b_{2})=0",
        ),
        tuple(rf"\operatorname{{arg}}(z_{{{k}}})" for k in (1, 2, 3, 4)), "", "",
    ),
]  # fmt: skip
"""Form, its coefficients, its equations, its branches, where there are any, and what must not vanish."""


@pytest.mark.parametrize("case", WRITTEN, ids=lambda case: f"{case[0].__name__} {case[1]}")
def test_each_form_reads_as_it_is_solved(
    case: tuple[type[Form], str, tuple[str, ...], tuple[str, ...], str, str],
) -> None:
    form, coefficients, equations, branches, reach, divisor = case
    g = ExpressionGraph(3)
    atoms = {
        name: g.atom("pose", name, np.array(PLAIN[like]), unknown=False)
        for name, like in zip("abcdfh", NAMES, strict=True)
    }
    e = [atoms[c] if c in atoms else g.const(float(c)) for c in coefficients.split()]
    kind = "prismatic" if form in (Linear, Quadratic) else "angle"
    w = FormulaWriter(Variable(kind, (1, 0)), e, g, Normalizer(), Abbreviations([]))
    found = form(*e).formula(w)
    assert tuple(map(latex, found.equations)) == equations
    assert tuple(map(latex, found.branches)) == branches
    assert ("" if found.reach is None else latex(found.reach)) == reach
    assert ("" if found.divisor is None else latex(found.divisor)) == divisor


def test_terms_of_a_combination_bring_their_signs() -> None:
    w = writer(PLAIN)
    g, (a, b, *_) = w.g, w.e
    x, y = m.name("x"), m.name("y")
    for first, second, text in (
        (a, b, r"a_{1}\,x+b_{1}\,y"),
        (g.neg(a), b, r"-a_{1}\,x+b_{1}\,y"),
        (a, g.neg(b), r"a_{1}\,x-b_{1}\,y"),
        (g.one, g.minus_one, "x-y"),
        (g.minus_one, g.one, "-x+y"),
        (g.const(-2.0), g.zero, r"-2\,x"),
        (g.zero, g.neg(b), r"-b_{1}\,y"),
        (g.zero, g.zero, "0"),
        (g.neg(g.add(a, b)), g.one, r"(-a_{1}-b_{1})\,x+y"),
        (a, g.sub(g.neg(a), b), r"a_{1}\,x+(-a_{1}-b_{1})\,y"),
        (g.sub(a, b), a, r"(a_{1}-b_{1})\,x+a_{1}\,y"),
    ):
        parts = [(w.sum(first), x), (w.sum(second), y)]
        assert latex(linear_combination(parts)) == text


@pytest.mark.parametrize("case", WRITTEN, ids=lambda case: f"{case[0].__name__} {case[1]}")
def test_a_sign_stands_before_a_term_an_operation_between_two(
    case: tuple[type[Form], str, tuple[str, ...], tuple[str, ...], str, str],
) -> None:
    g = ExpressionGraph(3)
    e = [
        given(g, PLAIN[NAMES[k]]) if c.isalpha() else g.const(float(c))
        for k, c in enumerate(case[1].split())
    ]
    w = FormulaWriter(Variable("angle", (1, 0)), e, g, Normalizer(), Abbreviations([]))
    found = case[0](*e).formula(w)
    for text in (*found.equations, *found.branches):
        marked = re.sub("<m(row|frac|sqrt|sup)>", "", text.mathml)
        assert not re.search(r'(^|<mo[^>]*>[(=]</mo>)<mo form="infix">', marked), marked
        assert not re.search(r'</m[in]><mo form="prefix">', marked), marked
