"""Symbols are written by what they stand for, whatever their names look like."""

from __future__ import annotations

from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.formulas.normalizer import Normalizer
from ikgen.formulas.notation import show
from ikgen.model.angle_function import cosine_and_sine


def test_a_length_is_no_cosine_by_its_name() -> None:
    g = ExpressionGraph(1)
    length, (cosine, sine) = g.param("cos_alpha_1", 2.0), cosine_and_sine("alpha_1")
    nodes = (length, g.param(cosine, 0.8), g.param(sine, 0.6))
    assert len(set(nodes)) == 3
    assert [show(Normalizer()(node)).latex for node in nodes] == [
        r"\mathit{cos}_{alpha1}", r"\text{cos }\alpha_{1}", r"\text{sin }\alpha_{1}"
    ]  # fmt: skip
