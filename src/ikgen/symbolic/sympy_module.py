"""A derivation as a Python module of SymPy expressions, which needs SymPy and NumPy only."""

from __future__ import annotations

import inspect
from typing import TYPE_CHECKING, Any

import sympy
from sympy.printing.str import StrPrinter

from ikgen import __version__
from ikgen.emit.rendering import render
from ikgen.errors import UsageError
from ikgen.forms.companion_roots import companion_roots
from ikgen.model.dh import Angle, DHChain, DHRow, Length
from ikgen.symbolic.circle_angles import circle_angles
from ikgen.symbolic.exact_numbers import exact_number
from ikgen.symbolic.joint_solutions import solutions
from ikgen.symbolic.matrix_equations import equations
from ikgen.symbolic.symbol_names import SymbolNames
from ikgen.symbolic.trig_polynomial_root import TrigPolynomialRoot
from ikgen.symbolic.trig_quartic_root import TrigQuarticRoot

if TYPE_CHECKING:
    from ikgen.emit.derivation import Derivation

__all__ = ["emit_derivation", "module_text"]

_print = StrPrinter({"sympy_integers": True, "order": "none"}).doprint


def emit_derivation(derivation: Derivation) -> dict[str, str]:
    """File name -> text."""
    return {f"{derivation.module.name}_sympy.py": module_text(derivation)}


def module_text(derivation: Derivation) -> str:
    """The text of `<name>_sympy.py`. Raises `UsageError` for an arm that the elimination solves: it has no
    formulas; and for one whose arm angle is held."""
    if derivation.graph.dh.arm_angle:
        raise UsageError(
            "the elbow's position at an arm angle is no expression of this output",
            hint="leave --emit sympy out, or hold a joint: --free JOINT",
        )
    if derivation.module.plan is not None:
        raise UsageError(
            "the elimination solves this arm: there are no formulas to write",
            hint="leave --emit sympy out; the report says what the elimination does",
        )
    dh, names = derivation.graph.dh, SymbolNames(derivation.graph.dh)
    found = solutions(derivation)
    equal = equations(derivation)
    expressions = [b.expression for branches in found.values() for b in branches]
    roots = [f for f in (TrigQuarticRoot, TrigPolynomialRoot) if any(e.has(f) for e in expressions)]
    return render(
        "sympy",
        "solution.py.jinja",
        name=derivation.module.name,
        version=__version__,
        source=derivation.module.source_name,
        roots=[
            inspect.getsource(f)
            for f in ((companion_roots, circle_angles, *roots) if roots else ())
        ],
        symbols=_symbols(names, found, dh),
        constants=_constants(names, dh),
        held=_held(derivation, names),
        solutions=[
            (
                branches[0].variable,
                [(_print(b.expression), [_print(c) for c in b.conditions]) for b in branches],
            )
            for branches in found.values()
        ],
        equations=[(_print(e.lhs), _print(e.rhs)) for e in equal],
        joints=[(repr(joint.name), _joint(dh, names, j)) for j, joint in enumerate(dh.joints)],
        rows=[_row(row, dh, names) for row in dh.rows],
        base=dh.X_base.tolist(),
        tip=dh.X_tip.tolist(),
        base_link=dh.base_link,
        tip_link=dh.tip_link,
        task=derivation.task.name,
        entries=derivation.task.entries,
        whole_pose=derivation.task.whole_pose,
    )


def _symbols(names: SymbolNames, found: Any, dh: DHChain) -> list[sympy.Symbol]:
    pose = [names.pose(f"r{i}{j}") for i in (1, 2, 3) for j in (1, 2, 3)]
    pose += [names.pose(f"p{x}") for x in "xyz"]
    variables = [branches[0].variable for branches in found.values()]
    joints = [names.joint(j) for j in range(dh.dof)]
    return list(dict.fromkeys([*pose, *names.constants.values(), *variables, *joints]))


def _constants(names: SymbolNames, dh: DHChain) -> list[tuple[sympy.Symbol, str]]:
    """Lengths and angles with their numbers; none for those that the table leaves open."""
    return [
        (names.constant(name), _print(exact_number(value).sympy))
        for name, value in dh.named_constants().items()
        if name not in dh.symbols
    ]


def _held(derivation: Derivation, names: SymbolNames) -> list[tuple[sympy.Symbol, str]]:
    """DH values of held joints by default."""
    out = []
    for joint, value in zip(
        derivation.module.free_indices, derivation.module.free_defaults, strict=True
    ):
        row = derivation.graph.dh.lead_row(joint)
        out.append((names.joint(joint), repr(row.scale * value + row.offset.value)))
    return out


def _joint(dh: DHChain, names: SymbolNames, joint: int) -> str:
    """The joint's own value."""
    row = dh.lead_row(joint)
    moved = names.joint(joint) - _value(row.offset, names)
    return str(_print(moved / exact_number(row.scale).sympy))


def _row(row: DHRow, dh: DHChain, names: SymbolNames) -> str:
    ratio = exact_number(dh.follows(row)[0]).sympy
    lead = dh.lead_row(row.driver)
    shift = _value(row.offset, names) - ratio * _value(lead.offset, names)
    variable = ratio * names.joint(row.driver) + shift
    theta, d = (variable, _value(row.d, names)), (_value(row.theta, names), variable)
    entries = (_value(row.alpha, names), _value(row.a, names), *(theta if row.revolute else d))
    return ", ".join(_print(entry) for entry in entries)


def _value(x: Angle | Length, names: SymbolNames) -> sympy.Expr:
    """A constant in SymPy: a symbol where it has a name, else exact."""
    if x.name is not None:
        return names.constant(x.name) * (x.sign if isinstance(x, Length) else 1)
    if isinstance(x, Angle) and x.exact is not None:
        return sympy.pi * sympy.Rational(x.exact.numerator, x.exact.denominator)
    return exact_number(x.value).sympy
