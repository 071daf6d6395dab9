"""What the IKBT paper tabulates of its robots, beside what ikgen finds.

D. Zhang, B. Hannaford, *IKBT: solving closed-form inverse kinematics with behavior tree*, arXiv 1711.05412:
the table of results by degrees of freedom, the solver chosen for each unknown of its three worked examples,
and its words on time.
"""

from __future__ import annotations

import statistics
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

__all__ = ["CHOSEN", "RESULTS", "comparison", "listed"]

EXPECTED = Path(__file__).resolve().parents[1] / "tests" / "robots" / "expected.toml"
RESULTS = {4: (4, 4), 5: (10, 10), 6: (5, 4)}
"""Degrees of freedom -> how many robots there were, and how many were solved."""
TIME = "a few minutes on a normal PC"
CHOSEN: Mapping[str, Mapping[str, str]] = {
    "Puma_paper": {
        "theta_1": "sine and cosine",
        "theta_3": "x2y2",
        "theta_23": "simultaneous",
        "theta_2": "algebraic",
        "theta_4": "tangent",
        "theta_5": "tangent",
        "theta_6": "tangent",
    },
    "Chair_Helper": {
        "d_1": "algebraic",
        "theta_2": "sine or cosine",
        "theta_3": "tangent",
        "theta_4": "tangent",
        "theta_5": "tangent",
    },
    "Olson13": {
        "theta_3": "tangent",
        "theta_4": "sine or cosine",
        "theta_5": "tangent",
        "theta_6": "tangent",
        "d_1": "algebraic",
        "d_2": "algebraic",
    },
}
"""Robot -> unknown -> leaf, by ikgen's names of leaves, in the paper's order."""


def listed() -> frozenset[str]:
    """The robots of the paper's list."""
    known = tomllib.loads(EXPECTED.read_text(encoding="utf-8"))
    return frozenset(name for name, facts in known.items() if facts["paper"])


def comparison(found: Sequence[tuple[str, int, float | None, Sequence[str]]]) -> Iterator[str]:
    """Lines; of each robot its name, degrees of freedom, seconds (None: not solved), and its unknowns in
    the order solved, each with its leaf."""
    own = listed()
    yield f"the paper's robots: {TIME} for each      ikgen: seconds for each"
    head = f"{'robots':>7} {'solved':>7}"
    yield f"{'degrees of freedom':>18} {head}      {head} {'median s':>9}"
    for dof in sorted({n for _, n, _, _ in found} | set(RESULTS)):
        times = [seconds for name, n, seconds, _ in found if name in own and n == dof]
        solved = [seconds for seconds in times if seconds is not None]
        paper = " ".join(f"{n:7}" for n in RESULTS[dof]) if dof in RESULTS else f"{'-':>7} {'-':>7}"
        median = f"{statistics.median(solved):9.2f}" if solved else f"{'-':>9}"
        yield f"{dof:18} {paper}      {len(times):7} {len(solved):7} {median}"
    for name, _, seconds, order in found:
        if name in CHOSEN and seconds is not None:
            leaves = ", ".join(f"{unknown} ({leaf})" for unknown, leaf in CHOSEN[name].items())
            yield f"{name}, leaves\n  paper: {leaves}\n  ikgen: {', '.join(order)}"
