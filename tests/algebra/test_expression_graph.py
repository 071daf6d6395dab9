"""Rewriting keeps values, equal expressions are one node, extended tables grow apart."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph

PROBES = 5
CONSTANTS = (0.0, 1.0, -1.0, 2.0, -0.5)
ARITHMETIC = ("add", "sub", "mul", "div", "neg", "square", "sqrt", "abs", "max", "select", "dot")

Instruction = tuple[str, int, int]
INSTRUCTIONS = st.lists(
    st.tuples(st.sampled_from(ARITHMETIC), st.integers(0, 12), st.integers(0, 12)),
    min_size=1,
    max_size=14,
)


def leaves(graph: ExpressionGraph) -> list[Expr]:
    """Constants, a parameter and three inputs, of either sign at the probes."""
    rng = np.random.default_rng(1)
    probe = rng.uniform(0.4, 1.7, (4, PROBES)) * rng.choice((-1.0, 1.0), (4, PROBES))
    atoms = [graph.atom("prismatic", (i,), probe[i], unknown=True) for i in range(3)]
    return [*(graph.const(x) for x in CONSTANTS), graph.param("a_1", 0.7, probe[3]), *atoms]


def grown(graph: ExpressionGraph, instructions: list[Instruction]) -> list[Expr]:
    """What the instructions make of the leaves and of what was made before."""
    pool = leaves(graph)
    for op, i, j in instructions:
        a, b = pool[-1 - i % len(pool)], pool[-1 - j % len(pool)]
        if op in ("neg", "square", "sqrt"):
            pool.append(getattr(graph, op)(a))
        elif op == "abs":
            pool.append(graph.unary("abs", a))
        elif op == "max":
            pool.append(graph.binary("max", a, b))
        elif op == "select":
            pool.append(graph.select(graph.binary("gt", pool[-1], graph.one), a, b))
        elif op == "dot":
            pool.append(graph.dot([a, b], [b, pool[-1]]))
        else:
            pool.append(getattr(graph, op)(a, b))
    return pool


def plain(instructions: list[Instruction]) -> list[np.ndarray]:
    """The same in plain arrays; examples whose values tell nothing of the rewriting are left out."""
    pool = [e.probe for e in leaves(ExpressionGraph(PROBES))]
    for op, i, j in instructions:
        a, b = pool[-1 - i % len(pool)], pool[-1 - j % len(pool)]
        last = pool[-1]
        if op == "div":
            assume(np.abs(b).min() > 1e-2)
        if op == "sqrt":
            assume(a.max() < 0.0 or a.min() > 1e-2)
        if op == "select":
            assume(np.abs(last - 1.0).min() > 1e-6)
        made = {
            "add": lambda a=a, b=b: a + b,
            "sub": lambda a=a, b=b: a - b,
            "mul": lambda a=a, b=b: a * b,
            "div": lambda a=a, b=b: a / b,
            "neg": lambda a=a: -a,
            "square": lambda a=a: a * a,
            "sqrt": lambda a=a: np.sqrt(np.maximum(a, 0.0)),
            "abs": lambda a=a: np.abs(a),
            "max": lambda a=a, b=b: np.maximum(a, b),
            "select": lambda a=a, b=b, last=last: np.where(last > 1.0, a, b),
            "dot": lambda a=a, b=b, last=last: a * b + b * last,
        }[op]()
        assume(np.abs(made).max() < 1e6)
        pool.append(made)
    return pool


def nodes(roots: list[Expr]) -> Iterator[Expr]:
    """Every node below the roots once."""
    seen: set[int] = set()
    stack = list(roots)
    while stack:
        node = stack.pop()
        if id(node) not in seen:
            seen.add(id(node))
            stack += node.args
            yield node


@settings(max_examples=300, deadline=None)
@given(INSTRUCTIONS)
def test_rewriting_keeps_the_value_at_the_probes(instructions: list[Instruction]) -> None:
    expected = plain(instructions)
    size = max(1.0, *(float(np.abs(x).max()) for x in expected))
    for node, value in zip(grown(ExpressionGraph(PROBES), instructions), expected, strict=True):
        np.testing.assert_allclose(node.probe, value, rtol=1e-10, atol=1e-12 * size)


@settings(deadline=None)
@given(INSTRUCTIONS)
def test_an_operation_on_the_same_arguments_is_one_node(instructions: list[Instruction]) -> None:
    graph = ExpressionGraph(PROBES)
    pool = grown(graph, instructions)
    assert all(a is b for a, b in zip(pool, grown(graph, instructions), strict=True))
    found = list(nodes(pool))
    told = {(n.op, n.name, n.value, tuple(id(a) for a in n.args)) for n in found}
    assert len(told) == len(found) == len({n.id for n in found})


@settings(deadline=None)
@given(INSTRUCTIONS)
def test_a_node_knows_what_it_depends_on(instructions: list[Instruction]) -> None:
    graph = ExpressionGraph(PROBES)
    for root in grown(graph, instructions):
        below = {n for n in nodes([root]) if n.atom is not None}
        assert set(graph.atoms_in(root.support)) == below
        assert root.is_fixed == (not below)


@settings(deadline=None)
@given(INSTRUCTIONS, INSTRUCTIONS, INSTRUCTIONS)
def test_extended_tables_grow_apart(
    common: list[Instruction], mine: list[Instruction], others: list[Instruction]
) -> None:
    graph, alone = ExpressionGraph(PROBES), ExpressionGraph(PROBES)
    shared = grown(graph, common)
    grown(alone, common)
    other = graph.extended()
    assert all(a is b for a, b in zip(shared, grown(other, common), strict=True))
    grown(other, others)
    other.atom("cos", (7,), np.full(PROBES, 0.3), unknown=True)
    assert graph.find_atom("cos", (7,)) is None
    new = graph.atom("sin", (7,), np.full(PROBES, 0.6), unknown=True)
    assert other.find_atom("sin", (7,)) is None
    assert graph.atoms_in(new.support) == [new]
    same = alone.atom("sin", (7,), np.full(PROBES, 0.6), unknown=True)
    assert (new.id, new.support) == (same.id, same.support)
    assert [n.id for n in grown(graph, mine)] == [n.id for n in grown(alone, mine)]


def test_forms_that_mean_the_same_are_one_node() -> None:
    g = ExpressionGraph(PROBES)
    x, y = leaves(g)[-2:]
    c = g.const
    same = {
        "a double negation": (g.neg(g.neg(x)), x),
        "a double not": (g.unary("not", g.unary("not", x)), x),
        "a sum and its mirror": (g.add(x, y), g.add(y, x)),
        "a product and its mirror": (g.mul(x, y), g.mul(y, x)),
        "nothing added": (g.add(x, g.zero), x),
        "nothing taken away": (g.sub(x, g.zero), x),
        "once": (g.mul(g.one, x), x),
        "never": (g.mul(x, g.zero), g.zero),
        "all taken away": (g.sub(x, x), g.zero),
        "a negative added": (g.add(x, g.neg(y)), g.sub(x, y)),
        "a negative first": (g.add(g.neg(x), y), g.sub(y, x)),
        "a negative taken away": (g.sub(x, g.neg(y)), g.add(x, y)),
        "a difference turned round": (g.neg(g.sub(x, y)), g.sub(y, x)),
        "twice": (g.add(x, x), g.mul(c(2.0), x)),
        "like terms": (g.add(g.mul(c(2.0), x), g.mul(x, c(3.0))), g.mul(c(5.0), x)),
        "unlike factors": (g.sub(g.mul(c(2.0), x), x), x),
        "signs in a product": (g.mul(g.neg(x), g.neg(y)), g.mul(x, y)),
        "factors in a product": (
            g.mul(g.mul(c(2.0), x), g.mul(c(0.5), y)),
            g.mul(x, y),
        ),
        "a number below": (g.div(x, c(4.0)), g.mul(c(0.25), x)),
        "one": (g.div(x, x), g.one),
        "a sign below": (g.div(x, g.neg(y)), g.neg(g.div(x, y))),
        "a sign above": (g.div(g.neg(x), y), g.neg(g.div(x, y))),
        "no choice": (g.select(g.binary("gt", x, y), x, x), x),
        "minus nothing": (c(-0.0), g.zero),
    }
    assert [what for what, (a, b) in same.items() if a is not b] == []


def test_a_root_of_a_negative_number_is_nothing() -> None:
    g = ExpressionGraph(PROBES)
    assert g.sqrt(g.const(-2.0)) is g.zero
    assert g.sqrt(g.const(9.0)) is g.const(3.0)


@pytest.mark.parametrize(("off", "vanishes"), [(0.0, True), (1e-7, False)])
def test_what_cancels_is_seen_to_vanish(off: float, vanishes: bool) -> None:
    g = ExpressionGraph(PROBES)
    x, y = leaves(g)[-2:]
    squares = g.add(g.square(x), g.add(g.mul(g.const(2.0), g.mul(x, y)), g.square(y)))
    left = g.sub(g.square(g.add(x, y)), squares)
    assert g.add(left, g.mul(g.const(off), x)).vanishes is vanishes
