"""Times of solvers as bars on a logarithmic scale: SVG, written out."""

from __future__ import annotations

import math
from html import escape

__all__ = ["picture"]

_ROW, _LEFT, _WIDTH, _TOP = 20, 240, 420, 34


def picture(bars: list[tuple[str, str, float]]) -> str:
    """The SVG text; bars are (arm, solver, microseconds a pose), those of an arm fastest first."""
    low = math.floor(math.log10(min(b[2] for b in bars)))
    high = math.ceil(math.log10(max(b[2] for b in bars)))
    arms = list(dict.fromkeys(b[0] for b in bars))
    parts: list[str] = []
    y = _TOP
    for arm in arms:
        parts.append(f'<text x="8" y="{y + 14}" font-weight="bold">{escape(arm)}</text>')
        y += _ROW
        for _, solver, value in sorted((b for b in bars if b[0] == arm), key=lambda b: b[2]):
            parts += _bar(solver, value, _place(value, low, high), y)
            y += _ROW
        y += 8
    width, height = _LEFT + _WIDTH + 70, y + 26
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
        f'viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="12">\n'
        f'<rect width="{width}" height="{height}" fill="#fff"/>\n'
        '<text x="8" y="18" font-size="14">All solutions of one pose, microseconds (one core, '
        "logarithmic scale)</text>"
    )
    return "\n".join([head, *_grid(low, high, y), *parts, "</svg>"]) + "\n"


def _place(value: float, low: int, high: int) -> float:
    """Where a value lies between the powers of ten `low` and `high`."""
    return _LEFT + _WIDTH * (math.log10(value) - low) / (high - low)


def _bar(solver: str, value: float, end: float, y: int) -> list[str]:
    fill = "#2a6f97" if solver.startswith("ikgen") else "#b9c4cc"
    return [
        f'<text x="{_LEFT - 8}" y="{y + 14}" text-anchor="end">{escape(solver)}</text>',
        f'<rect x="{_LEFT}" y="{y + 3}" width="{max(end - _LEFT, 1):.1f}" height="14" '
        f'fill="{fill}"/>',
        f'<text x="{end + 5:.1f}" y="{y + 14}" fill="#456">{float(f"{value:.3g}"):,g}</text>',
    ]


def _grid(low: int, high: int, bottom: int) -> list[str]:
    """A line and its number at each power of ten."""
    lines = []
    for k in range(low, high + 1):
        x = _place(10.0**k, low, high)
        lines.append(f'<path d="M{x:.1f} {_TOP} V{bottom}" stroke="#dde3e7"/>')
        lines.append(
            f'<text x="{x:.1f}" y="{bottom + 16}" text-anchor="middle" fill="#456">{10.0**k:,g}</text>'
        )
    return lines
