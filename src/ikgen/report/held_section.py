"""The joint that is held: why, and between which of its values the pose of the example has solutions."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ikgen.emit.derivation import Derivation
from ikgen.lowering.held_angle import held_values
from ikgen.model.arrays import Array
from ikgen.model.chain import REVOLUTE
from ikgen.model.dh import ARM_ANGLE_OPTION, DHChain
from ikgen.report.document import Block, Heading, Paragraph, Picture
from ikgen.report.worked_example import WorkedExample
from ikgen.verify.runners.python_module import PythonModule

__all__ = ["held_section"]

_IN_WORDS = {ARM_ANGLE_OPTION: "the arm angle"}
_VALUES = 145
_WIDTH, _HEIGHT, _LEFT, _TOP, _BOTTOM = 560.0, 190.0, 46.0, 16.0, 44.0


@dataclass(frozen=True, slots=True)
class _Sweep:
    """`count` (n,) solutions inside the limits at each of the `values` (n,), rad or m, of what is held."""

    values: Array
    count: Array
    now: float
    revolute: bool

    @property
    def scale(self) -> float:
        """To what is written at the axis: degrees or mm."""
        return 180 / math.pi if self.revolute else 1e3


def held_section(
    derivation: Derivation, example: WorkedExample, runner: PythonModule
) -> list[Block]:
    """Nothing for an arm without a held joint; the plot is for the first of them."""
    dh = derivation.reading.dh
    if not dh.free:
        return []
    several = len(dh.free) > 1
    lead = (
        f"The arm has more joints than its task asks for. {' and '.join(_held_names(dh))} "
        f"{'are' if several else 'is'} held: solve takes {'their values' if several else 'its value'} "
        "with the pose, and each value has solutions of its own, or none."
    )
    why = f" ikgen chose so: {derivation.held.words}." if derivation.held is not None else ""
    sweep = _sweep(derivation, example, runner)
    name = _held_names(dh)[0]
    words = _spans(sweep)
    shown = (
        f"With the pose of the example below and {name} swept, there are solutions inside the limits "
        f"{words}; the line marks the example's own value."
    )
    svg = _plot(sweep, f"Solutions of the example's pose over {name}")
    caption = f"Number of solutions inside the limits over {name}"
    return [
        Heading(("The joint to hold",), anchor="held"),
        Paragraph((lead + why,)),
        Paragraph((shown,)),
        Picture(svg, "", caption),
    ]


def _held_names(dh: DHChain) -> list[str]:
    """What is held, in words, in the order in which the solver takes the values."""
    return [_IN_WORDS.get(held.name, held.name) for held in dh.held_inputs]


def _sweep(derivation: Derivation, example: WorkedExample, runner: PythonModule) -> _Sweep:
    dh = derivation.reading.dh
    now = held_values(dh, example.q, example.pose)
    assert now is not None
    swept = dh.held_inputs[0]
    revolute = swept.kind == REVOLUTE
    wide = math.pi if revolute else 1.0
    low, high = max(swept.limits.lower, -wide), min(swept.limits.upper, wide)
    values = np.linspace(low, high, _VALUES)
    held = np.tile(now, (_VALUES, 1))
    held[:, 0] = values
    held[np.abs(values - now[0]).argmin(), 0] = now[0]  # where there are solutions for sure
    poses = np.broadcast_to(example.pose, (_VALUES, 4, 4))
    count = runner.solve_many(poses, free=held).count.astype(float)
    return _Sweep(values, count, float(now[0]), revolute)


def _spans(sweep: _Sweep) -> str:
    """The values with solutions, as intervals."""
    on = np.flatnonzero(sweep.count > 0)
    if not len(on):
        return "at none of the values looked at"
    groups = np.split(on, np.flatnonzero(np.diff(on) > 1) + 1)
    unit = "°" if sweep.revolute else " mm"
    ends = [(sweep.values[g[0]] * sweep.scale, sweep.values[g[-1]] * sweep.scale) for g in groups]
    words = [f"from {a:.0f}{unit} to {b:.0f}{unit}" for a, b in ends]
    step = (sweep.values[1] - sweep.values[0]) * sweep.scale
    return " and ".join(words) + f" (looked at every {step:.2g}{unit})"


def _plot(sweep: _Sweep, title: str) -> str:
    low, high = float(sweep.values[0]), float(sweep.values[-1])
    most = max(int(sweep.count.max()), 1)
    floor = _HEIGHT - _BOTTOM

    def x(value: float) -> float:
        return _LEFT + (value - low) / max(high - low, 1e-9) * (_WIDTH - _LEFT - 12)

    def y(count: float) -> float:
        return floor - count / most * (floor - _TOP)

    half = (sweep.values[1] - sweep.values[0]) / 2
    bars = "".join(
        f"M{x(max(v - half, low)):.1f} {floor:.1f}V{y(n):.1f}H{x(min(v + half, high)):.1f}V{floor:.1f}"
        for v, n in zip(sweep.values.tolist(), sweep.count.tolist(), strict=True)
        if n
    )
    unit = "degrees" if sweep.revolute else "mm"
    parts = [
        f'<path d="{bars or f"M{x(low):.1f} {floor:.1f}"}" fill="#e8973a" fill-opacity="0.8"/>'
    ]
    parts += [_tick(8, y(n) + 4, str(n)) for n in sorted({0, most // 2, most})]
    parts += [
        _tick(x(v) - 10, floor + 18, f"{v * sweep.scale:.0f}") for v in np.linspace(low, high, 5)
    ]
    parts.append(_tick(_WIDTH / 2 - 20, _HEIGHT - 6, unit))
    parts.append(
        f'<path class="line" stroke="#345" fill="none" d="M{_LEFT:g} {_TOP:g}V{floor:g}H{_WIDTH - 12:g}"/>'
    )
    parts.append(
        f'<path class="now" stroke="#3b78d8" stroke-width="2" d="M{x(sweep.now):.1f} {_TOP:g}V{floor:g}"/>'
    )
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_WIDTH:g} {_HEIGHT:g}" '
        f'width="{_WIDTH:g}" height="{_HEIGHT:g}" role="img" font-family="sans-serif">'
        f"<title>{title}</title>{''.join(parts)}</svg>"
    )


def _tick(x: float, y: float, words: str) -> str:
    return (
        f'<text class="soft" x="{x:.1f}" y="{y:.1f}" font-size="11" fill="#55636f">{words}</text>'
    )
