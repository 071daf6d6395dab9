"""All that "How far you can trust this" tells: runs the commands, records, and fills the page's table.

    python -m benchmarks.trust [--fill]

With `--fill` nothing is run: the table, and that of CONTRIBUTING.md, are made from what was recorded. The
score of mutations takes hours, and is recorded by itself. Exit code 1 where a command found anything wrong.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

from benchmarks.results import Measured, read_result

__all__ = ["COMMANDS", "PAGES", "filled_in", "main"]

_ROOT = Path(__file__).resolve().parents[1]
END = "<!-- end of figures -->\n"


def _mutants(found: dict[str, object]) -> list[tuple[str, str]]:
    rows = []
    for kind, words in (
        ("read", "mutants read in one process"),
        ("run", "mutants run to verified code"),
    ):
        counts = found[kind]
        assert isinstance(counts, dict)
        wrong = sum(n for said, n in counts.items() if said.startswith("WRONG"))
        rows.append((f"{sum(counts.values()):,} {words}", f"{wrong} wrong"))
    return rows


def _kills(found: dict[str, object]) -> list[tuple[str, str]]:
    return [(f"{found['kills']} kills over outputs that are there", f"{found['wrong']} wrong")]


def _faults(found: dict[str, object]) -> list[tuple[str, str]]:
    return [(f"{found['faults']} faults of the disk", f"{found['wrong']} wrong")]


def _pairs(found: dict[str, object]) -> list[tuple[str, str]]:
    return [(f"{found['pairs']} pairs of runs at once", f"{found['wrong']} wrong")]


def _fuzzed(found: dict[str, object], what: str) -> list[tuple[str, str]]:
    by_name, runs = found["found"], found["runs"]
    assert isinstance(by_name, dict) and isinstance(runs, int)
    wrong = sum(said != "nothing" for said in by_name.values())
    words = f"{runs:,} runs of a fuzzer on each of {len(by_name)} {what}"
    return [(words, "nothing" if not wrong else f"something in {wrong} of them")]


def _fuzz_readers(found: dict[str, object]) -> list[tuple[str, str]]:
    return _fuzzed(found, "readers")


def _fuzz_header(found: dict[str, object]) -> list[tuple[str, str]]:
    return _fuzzed(found, "headers, with sanitizers")


def _determinism(found: dict[str, object]) -> list[tuple[str, str]]:
    rows = found["differing"]
    assert isinstance(rows, dict)
    words = f"{len(rows)} surroundings, {found['files']} files each"
    return [(words, f"{sum(map(bool, rows.values()))} with a file that differs")]


def _planted(found: dict[str, object]) -> list[tuple[str, str]]:
    left = found["unfound"]
    assert isinstance(left, list)
    return [(f"{found['planted']} defects planted in emitted code", f"{len(left)} not found")]


def _mutation_score(found: dict[str, object]) -> list[tuple[str, str]]:
    by_package = found["found"]
    assert isinstance(by_package, dict)
    noticed = sum(row[0] for row in by_package.values())
    words = f"{found['mutations']:,} small changes of ikgen's own code, one at a time"
    return [(words, f"{noticed} noticed by a short test")]


_ROWS = {
    "mutants": _mutants, "kills": _kills, "faults": _faults, "pairs": _pairs,
    "determinism": _determinism, "planted": _planted, "fuzz_readers": _fuzz_readers,
    "fuzz_header": _fuzz_header, "mutation_score": _mutation_score,
}  # fmt: skip
COMMANDS = tuple(name for name in _ROWS if name != "mutation_score")
"""What is run."""


def trust_table() -> str:
    """The table of all commands."""
    lines = ["| command | what | found |", "|---|---|---|"]
    measured: list[Measured] = [read_result(name) for name in _ROWS]
    for name, one in zip(_ROWS, measured, strict=True):
        lines += [f"| `{one.command}` | {a} | {b} |" for a, b in _ROWS[name](one.found)]
    said = ", ".join(dict.fromkeys(f"`{m.commit}` on {m.date}" for m in measured))
    return "\n".join(lines) + f"\n\nMeasured at {said}.\n"


def score_table() -> str:
    """The table of mutations by package."""
    one = read_result("mutation_score")
    rows = {**one.found["found"]}
    rows["all"] = [sum(row[k] for row in rows.values()) for k in (0, 1, 2)]
    head = "| package | changes tried | noticed | share | change nothing, as looked at |"
    lines = [head, "|---|---|---|---|---|"]
    for name, (n, every, same) in rows.items():
        lines.append(f"| {name} | {every} | {n} | {n / every:.0%} | {same} |")
    seed = one.found["seed"]
    return (
        "\n".join(lines)
        + f"\n\nThe first {rows['all'][1]} of seed {seed}, at `{one.commit}` on {one.date}.\n"
    )


PAGES: dict[Path, tuple[str, Callable[[], str]]] = {
    _ROOT / "docs" / "explanation" / "trust.md": ("<!-- figures: trust -->\n", trust_table),
    _ROOT / "CONTRIBUTING.md": ("<!-- figures: mutation score -->\n", score_table),
}
"""Page -> the mark before its table, and what makes it."""


def filled_in(page: Path, text: str) -> str:
    """A page's text with its table made from what was recorded."""
    start, table = PAGES[page]
    before, _, rest = text.partition(start)
    _, mark, after = rest.partition(END)
    if not mark:
        raise ValueError(f"{page.name} has no marks for its table")
    return before + start + table() + END + after


def main() -> int:
    """Run, record, and write the page."""
    parser = argparse.ArgumentParser(description="All figures of the page on trust.")
    parser.add_argument("--fill", action="store_true", help="only make the table")
    options = parser.parse_args()
    codes = [0]
    for name in () if options.fill else COMMANDS:
        print(f"== {name}", flush=True)
        codes.append(
            subprocess.run([sys.executable, "-m", f"benchmarks.{name}", "--record"]).returncode
        )
    for page in PAGES:
        page.write_text(filled_in(page, page.read_text(encoding="utf-8")), encoding="utf-8")
    return max(codes)


if __name__ == "__main__":
    sys.exit(main())
