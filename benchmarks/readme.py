"""Fills the figures of README.md, of the page of comparisons and of the documentation's home page, between
their marks, from the recorded results.

    python -m benchmarks.readme [--check]

A block starts with `<!-- figures: NAME -->` and ends with `<!-- end of figures -->`. What lies between is
made here, from `benchmarks/results/`; nothing else of a page is touched. The picture of the comparison is
drawn from there too. The commands write their results with `--record`. `--check` writes nothing and exits
with 1 where a block or the picture is not what was recorded.
"""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Callable, Collection, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from benchmarks.peer_picture import picture
from benchmarks.results import Measured, read_result
from benchmarks.shown_names import ARMS, CLASSES, RANDOM, SOAKED

__all__ = [
    "BLOCKS", "COMPARISON", "HOME", "PAGE", "PAGES", "PICTURE", "MarkError", "drawn", "filled_in",
]  # fmt: skip

COMPARISON = Path(__file__).resolve().parents[1] / "docs/explanation/comparison.md"
PAGE = Path(__file__).resolve().parents[1] / "README.md"
PICTURE = Path(__file__).with_name("peers.svg")
HOME = COMPARISON.parents[1] / "pictures/speed_ur5e.svg"
"""The part of the picture that the home page of the documentation shows."""
_START = re.compile(r"<!-- figures: (\w+) -->\n")
_END = "<!-- end of figures -->\n"


class MarkError(Exception):
    """A block without an end, an end without a block, a block twice, missing or not known."""


def filled_in(
    text: str, blocks: Collection[str], read: Callable[[str], Measured] = read_result
) -> str:
    """The text of a page with these blocks, each made anew; raises `MarkError` where the marks are not in
    order."""
    names = _START.findall(text)
    if sorted(names) != sorted(blocks) or text.count(_END) != len(names):
        raise MarkError(f"blocks {names}, {text.count(_END)} ends; there must be {list(blocks)}")
    parts = _START.split(text)
    out = [parts[0]]
    for name, rest in zip(parts[1::2], parts[2::2], strict=True):
        old, mark, after = rest.partition(_END)
        if not mark or _END in after or _START.search(old):
            raise MarkError(f"the block {name} does not end before the next")
        out += [f"<!-- figures: {name} -->\n", BLOCKS[name](read), _END, after]
    return "".join(out)


def _table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    text = "\n".join("| " + " | ".join(line) + " |" for line in lines)
    return text.replace("| --- ", "|---").replace("--- |", "---|") + "\n"


def _source(*measured: Measured) -> str:
    """Where figures come from."""
    said = dict.fromkeys(f"`{m.commit}` on {m.date}" for m in measured)
    return f"\nMeasured at {', '.join(said)}.\n"


def _class(family: str) -> str:
    name = CLASSES.get(family, family)
    return re.sub(r"^(\dR) (?!,)", r"\1, ", name)


def _classes(name: str, read: Callable[[str], Measured]) -> str:
    measured = read(name)
    rows = [
        [_class(c["family"]), str(c["arms"]), str(c["solved"]),
         *(f"{x:.1f} s" for x in (*c["waited"], *c["processor"]))]
        for c in measured.found["classes"]
    ]  # fmt: skip
    head = (
        "class", "arms", "solved and verified", "median", "longest", "of the processor", "longest",
    )  # fmt: skip
    left = measured.found["left"]
    words = f"\nWithout a closed form: {', '.join(left)}.\n" if left else ""
    return _table(head, rows) + words + _source(measured)


def _speed(read: Callable[[str], Measured]) -> str:
    measured, narrow = read("speed_by_class"), read("speed_by_class_avx2")
    found, other = measured.found, narrow.found
    narrower = {c["family"]: [f"{c[x]:.2f}" for x in _RATIOS] for c in other["classes"]}
    rows = [
        [_class(c["family"]), str(c["arms"]), f"{c['single']:,.0f}", f"{c['worst_single']:,.0f}",
         f"{c['batch']:,.0f}", *(f"{c[x]:.2f}" for x in _RATIOS), *narrower[c["family"]]]
        for c in found["classes"]
    ]  # fmt: skip
    head = (
        "class", "arms", "ns a pose, median", "longest", "in batches, median",
        "of the baseline's", "longest", f"{other['instructions']}: of the baseline's", "longest",
    )  # fmt: skip
    words = (
        f"\nThe baseline takes {found['baseline']:.0f} ns with {found['instructions']}, "
        f"{other['baseline']:.0f} ns on the other machine, which has {other['instructions']}.\n"
    )
    left = [*found["left"], *other["left"]]
    untimed = f"Not timed: {', '.join(left)}.\n" if left else ""
    return _table(head, rows) + words + untimed + _source(measured, narrow)


_RATIOS = ("ratio", "worst_ratio")


def _tables(read: Callable[[str], Measured]) -> str:
    measured = [read(name) for name in ("suite", "suite_chosen")]
    head = ("command", *_COUNTED.values(), "median")
    rows = [[f"`{m.command}`", *_counts(m.found)] for m in measured]
    return _table(head, rows) + _source(*measured)


def _random(read: Callable[[str], Measured]) -> str:
    measured = read("random_chains")
    head = (
        "joints", *_COUNTED.values(), "median", "missed next to singularities",
        "poses with as many solutions by search",
    )  # fmt: skip
    rows = [
        [RANDOM.get(c["class"], c["class"]), *_counts(c), _beside(c),
         f"{c['equal']} of {c['searched']}" if c["searched"] else "–"]
        for c in measured.found["classes"]
    ]  # fmt: skip
    return _table(head, rows) + _source(measured)


def _beside(found: dict[str, Any]) -> str:
    count = found["beside_tables"]
    words = f"{found['beside']}, in {count} table{'s' * (count != 1)}"
    return words if found["beside"] else "0"


_COUNTED = {
    "tables": "tables", "by_rules": "solved by rules", "by_elimination": "by elimination",
    "wrong": "wrong rows", "missed": "missed",
}  # fmt: skip


def _counts(found: dict[str, Any]) -> list[str]:
    return [*(str(found[n]) for n in _COUNTED), f"{found['median']:.1f} s"]


def _peers(read: Callable[[str], Measured]) -> str:
    measured = read("peers")
    times: dict[str, dict[str, float]] = {}
    for row in measured.found["times"]:
        times.setdefault(row["solver"], {})[row["arm"]] = row["microseconds"]
    own_first = sorted(
        times, key=lambda solver: (not solver.startswith("ikgen"), min(times[solver].values()))
    )
    arms = [arm for arm in ARMS if any(arm in row for row in times.values())]
    rows = [[solver, *(_short(times[solver].get(arm)) for arm in arms)] for solver in own_first]
    return _table(("solver", *(ARMS[arm] for arm in arms)), rows) + _source(measured)


def drawn(read: Callable[[str], Measured] = read_result, arm: str = "") -> str:
    """The picture of the comparison with other solvers, of one arm where it is named."""
    times = [row for row in read("peers").found["times"] if arm in ("", row["arm"])]
    return picture([(row["arm"], row["solver"], row["microseconds"]) for row in times])


def _short(value: Any) -> str:
    """Two digits of a time in microseconds; a dash where there is none."""
    if value is None:
        return "–"
    if value < 100:
        return f"{value:.2f}" if value < 1 else f"{value:.1f}" if value < 10 else f"{value:.0f}"
    return f"{10 * round(value / 10):,}" if value < 1000 else f"{100 * round(value / 100):,}"


def _answers(read: Callable[[str], Measured]) -> str:
    measured = read("peer_answers")
    cells: dict[str, dict[str, str]] = {}
    for row in measured.found["answers"]:
        found = "" if row["found"] is None else f" ({_percent(row['found'])})"
        cells.setdefault(row["solver"], {})[row["arm"]] = f"{_percent(row['answered'])}{found}"
    arms = [arm for arm in ARMS if any(arm in row for row in cells.values())]
    rows = [[solver, *(row.get(arm, "–") for arm in arms)] for solver, row in cells.items()]
    return _table(("solver", *(ARMS[arm] for arm in arms)), rows) + _source(measured)


def _soak(read: Callable[[str], Measured]) -> str:
    measured = read("soak")
    rows = []
    for name, found in measured.found["arms"].items():
        poses, missed, empty, *beside = map(sum, zip(*found["decades"], strict=True))
        counts = (found["rows"], found["wrong"], poses, missed, empty, *beside)
        rows.append([name.replace("_", " "), *(f"{count:,}" for count in counts)])
    return _table(("arm", *SOAKED), rows) + _source(measured)


def _collection_soak(read: Callable[[str], Measured]) -> str:
    measured = read("collection_soak")
    rows = []
    for c in measured.found["classes"]:
        counts = (c["arms"], c["rows"], c["wrong"], *c["poses"])
        rows.append([_class(c["family"]), *(f"{count:,}" for count in counts)])
    return _table(("class", "arms", *SOAKED), rows) + _source(measured)


def _held(read: Callable[[str], Measured]) -> str:
    measured = read("held_values")
    rows = []
    for form in measured.found["forms"]:
        counts = (form[n] for n in ("arms", "intervals", "missed", "off", "searches", "worse"))
        times = (form[n] for n in ("motion", "motion_most", "search", "search_most"))
        rows.append([form["form"], *(f"{n:,}" for n in counts), *map(_short, times)])
    head = (
        "closed form", "arms", "intervals", "missed", "ends off", "searches", "worse",
        "`self_motion`", "most", "`search`", "most",
    )  # fmt: skip
    return _table(head, rows) + _source(measured)


def _batch(read: Callable[[str], Measured]) -> str:
    """The shortest time that the home page tells."""
    rows = read("peers").found["times"]
    fast = min(r["microseconds"] for r in rows if r["solver"].startswith("ikgen, C++ batch"))
    return f"{_short(fast)} µs a pose in batches of C++, [measured](explanation/comparison.md#speed).\n"


def _percent(share: float) -> str:
    return f"{100 * share:.3g} %"


BLOCKS: dict[str, Callable[[Callable[[str], Measured]], str]] = {
    "public": partial(_classes, "public"),
    "corpus": partial(_classes, "corpus"),
    "speed": _speed,
    "tables": _tables,
    "random": _random,
    "peers": _peers,
    "answers": _answers,
    "soak": _soak,
    "collection": _collection_soak,
    "held": _held,
    "batch": _batch,
}
"""Block -> its text."""
PAGES = {
    PAGE: ("public", "corpus", "speed", "soak", "collection", "random", "tables", "peers"),
    COMPARISON: ("peers", "answers"),
    COMPARISON.parents[1] / "how-to/redundant-arms.md": ("held",),
    COMPARISON.parents[1] / "index.md": ("batch",),
}
"""Page -> its blocks."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Write the page, or say whether it is what was recorded."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--check", action="store_true")
    options = parser.parse_args(arguments)
    made = {page: filled_in(page.read_text(encoding="utf-8"), PAGES[page]) for page in PAGES}
    made |= {PICTURE: drawn(), HOME: drawn(arm="UR5e")}
    old = {path for path, text in made.items() if path.read_text(encoding="utf-8") != text}
    for path in old:
        print(f"{path.name} is not what was recorded")
        if not options.check:
            path.write_text(made[path], encoding="utf-8")
    return int(bool(old) and options.check)


if __name__ == "__main__":
    sys.exit(main())
