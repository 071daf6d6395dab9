"""The behavior tree as a picture: the path that every round took is lit, one round at a time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape

from ikgen.solver.session import Tick

__all__ = ["mark", "tree_picture"]

_ACROSS, _DOWN, _WIDE, _HIGH = 164.0, 25.0, 148.0, 20.0
_SIGNS = {"sequence": "→", "selector": "?", "or": "∨"}

Path = tuple[str, ...]


def mark(tick: Tick) -> str:
    """The number that a node gave, or whether it succeeded."""
    first = tick.detail.split(" ", 1)[0]
    if tick.outcome != "success":
        return "–"
    return first if first.isdigit() else "yes"


def tree_picture(outline: Sequence[Path], ticks: Sequence[Tick], told: Mapping[int, str]) -> str:
    """HTML: buttons for the rounds, the tree, and below it what the round solved (`told`, by round). What
    is shown follows from the button that is pressed, without a script."""
    rounds = sorted({t.round for t in ticks})
    place = _places(outline)
    kinds = {t.path: t.kind for t in ticks}
    width = max(x for x, _ in place.values()) + _WIDE + 8
    height = max(y for _, y in place.values()) + _HIGH
    parts = [_line(place, path, "line") for path in outline if path[:-1] in place]
    parts += [_box(place[path], "box") for path in outline]
    for number, k in enumerate(rounds, start=1):
        seen = [t for t in ticks if t.round == k]
        inside = "".join(_tick(place, t) for t in seen if t.path in place)
        parts.append(f'<g class="round r{number}">{inside}</g>')
    parts += [_name(place[path], path, kinds.get(path, "")) for path in outline]
    svg = (
        f'<svg xmlns="http://www.w3.org/2000/svg" class="tree" viewBox="0 0 {width:g} {height:g}" '
        f'width="{width:g}" height="{height:g}" role="img" font-family="sans-serif">'
        f"<title>The behavior tree, round by round</title>{_shown(len(rounds))}{''.join(parts)}</svg>"
    )
    return (
        f'<div class="rounds">{_buttons(rounds)}<figure>{svg}</figure>{_lines(rounds, told)}</div>'
    )


def _shown(rounds: int) -> str:
    """Style: of every round's parts those are shown whose button is pressed."""
    rules = (
        f".rounds>input.r{k}:checked~figure g.r{k}{{display:inline}}"
        f".rounds>input.r{k}:checked~p.r{k}{{display:block}}"
        for k in range(1, rounds + 1)
    )
    return f"<style>{''.join(rules)}</style>"


def _places(outline: Sequence[Path]) -> dict[Path, tuple[float, float]]:
    """The left middle of every node: columns by depth, a row for each leaf, parents between theirs."""
    rows = 0
    y: dict[Path, float] = {}
    for path in outline:
        if not any(other[:-1] == path for other in outline):
            rows += 1
            y[path] = rows * _DOWN
    for path in sorted(outline, key=len, reverse=True):
        below = [y[other] for other in outline if other[:-1] == path]
        if below:
            y[path] = (min(below) + max(below)) / 2
    return {path: (6 + (len(path) - 1) * _ACROSS, y[path]) for path in outline}


def _line(place: Mapping[Path, tuple[float, float]], path: Path, kind: str) -> str:
    (x1, y1), (x2, y2) = place[path[:-1]], place[path]
    x1, middle = x1 + _WIDE, (x1 + _WIDE + x2) / 2
    return (
        f'<path class="{kind}" d="M{x1:g} {y1:g}C{middle:g} {y1:g} {middle:g} {y2:g} {x2:g} {y2:g}" '
        'fill="none"/>'
    )


def _box(at: tuple[float, float], kind: str) -> str:
    return (
        f'<rect class="{kind}" x="{at[0]:g}" y="{at[1] - _HIGH / 2:g}" width="{_WIDE:g}" '
        f'height="{_HIGH:g}" rx="5"/>'
    )


def _name(at: tuple[float, float], path: Path, kind: str) -> str:
    name = path[-1].rpartition(": ")[2]
    words = f"{_SIGNS[kind]} {name}" if kind in _SIGNS else name
    return f'<text class="ink" x="{at[0] + 7:g}" y="{at[1] + 4:g}" font-size="11">{escape(words)}</text>'


def _tick(place: Mapping[Path, tuple[float, float]], tick: Tick) -> str:
    """A node that ran in this round: lit with the way to it where it succeeded."""
    good = tick.outcome == "success"
    at = place[tick.path]
    way = _line(place, tick.path, "litline") if good and tick.path[:-1] in place else ""
    shown = mark(tick)
    words = shown if shown != "yes" or tick.kind not in _SIGNS else ""
    number = (
        f'<text class="soft" x="{at[0] + _WIDE - 6:g}" y="{at[1] + 4:g}" font-size="10" '
        f'text-anchor="end">{words}</text>'
    )
    return f"{way}{_box(at, 'lit' if good else 'failed')}{number if words else ''}"


def _buttons(rounds: Sequence[int]) -> str:
    out = []
    for number, k in enumerate(rounds, start=1):
        on = ' checked="checked"' if number == 1 else ""
        out.append(
            f'<input type="radio" name="round" class="r{number}" id="round-{k}"{on}/>'
            f'<label for="round-{k}">round {k}</label>'
        )
    return "".join(out)


def _lines(rounds: Sequence[int], told: Mapping[int, str]) -> str:
    return "".join(
        f'<p class="r{number}">Round {k}: {told.get(k, "nothing that fits")}.</p>'
        for number, k in enumerate(rounds, start=1)
    )
