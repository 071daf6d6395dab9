"""Robots as other tools would have written them: soaked headers of files whose numbers are changed.

    python -m benchmarks.perturbed_arms [--count 100] [--seed 1] [--poses 20000] [--near 20000]
        [--family TEXT] [--keep DIR]

Draws arms of the collection (or of the fixtures without it), of all classes alike, and changes the
numbers of their joints' origins: turns rounded to 2 to 5 digits, all origins moved by up to 1e-6 to
1e-3 m, and turned by as many rad, one alone, or axes turned round. Each is emitted and put through
`soak`, without the verification that would refuse it. A line for each arm, and the counts of those that
failed, as `benchmarks.table_soak` prints them.
"""

from __future__ import annotations

import argparse
import sys
import xml.etree.ElementTree as ET
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.command_line import Source, sources
from benchmarks.drawn_soaks import add_options, soak_drawn

Vector = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Change:
    """What happens to the origins of a chain's joints: turns are rounded to `digits`; origins are moved by
    up to `shift` (m) and turned by up to `turn` (rad), of `single` one joint's alone; `flipped`: whether
    axes are turned round, half of them."""

    digits: int | None = None
    shift: float = 0.0
    turn: float = 0.0
    single: bool = False
    flipped: bool = False


CHANGES: dict[str, Change] = {
    **{f"{n} digits": Change(digits=n) for n in (2, 3, 4, 5)},
    **{f"moved {x:.0e} m": Change(shift=x) for x in (1e-6, 1e-5, 1e-4, 1e-3)},
    **{f"measured {x:.0e}": Change(shift=x, turn=x) for x in (1e-5, 1e-4, 1e-3)},
    "one moved 1e-04 m": Change(shift=1e-4, single=True),
    "one turned 1e-03 rad": Change(turn=1e-3, single=True),
    "axes turned round": Change(flipped=True),
}


def perturbed(text: str, tip: str, change: Change, random: np.random.Generator) -> str:
    """The URDF with the joints above link `tip` changed."""
    root = ET.fromstring(text)
    joints = _above(root, tip)
    alone = int(random.integers(len(joints)))
    for i, joint in enumerate(joints):
        touched = float(alone == i or not change.single)
        origin = joint.find("origin")
        if origin is None:
            origin = ET.SubElement(joint, "origin")
        xyz, rpy = _numbers(origin, "xyz"), _numbers(origin, "rpy")
        if change.digits is not None:
            rpy = np.round(rpy, change.digits)
        _write(origin, "xyz", xyz + touched * change.shift * random.uniform(-1.0, 1.0, 3))
        _write(origin, "rpy", rpy + touched * change.turn * random.uniform(-1.0, 1.0, 3))
        axis = joint.find("axis")
        if change.flipped and axis is not None and random.random() < 0.5:
            _write(axis, "xyz", -_numbers(axis, "xyz"))
    return ET.tostring(root, encoding="unicode")


def _above(root: ET.Element, tip: str) -> list[ET.Element]:
    """The joints from a link up to the root of the tree."""
    parents = {_link(joint, "child"): joint for joint in root.findall("joint")}
    found = []
    link = tip
    while link in parents:
        found.append(parents.pop(link))
        link = _link(found[-1], "parent")
    return found


def _link(joint: ET.Element, end: str) -> str:
    element = joint.find(end)
    return "" if element is None else element.get("link", "")


def _numbers(element: ET.Element, name: str) -> Vector:
    return np.array([float(x) for x in element.get(name, "0 0 0").split()])


def _write(element: ET.Element, name: str, values: Vector) -> None:
    element.set(name, " ".join(repr(float(x)) for x in values))


def drawn(seed: int, number: int, family: str = "") -> tuple[Source, str, np.random.Generator]:
    """An arm, the name of a change, and what to draw the change's numbers with; classes count alike."""
    random = np.random.default_rng([seed, number])
    arms = sources(("corpus",)) or sources(("fixtures",))
    arms = [
        s for s in arms if s.file is not None and s.file.suffix == ".urdf" and family in s.family
    ]
    if not arms:
        raise SystemExit(f"no arm with a URDF file is of a class '{family}'")
    kind = str(random.choice(sorted({s.family for s in arms})))
    arm = arms[int(random.choice([i for i, s in enumerate(arms) if s.family == kind]))]
    return arm, str(random.choice(list(CHANGES))), random


def changed_arm(number: int, folder: Path, seed: int, family: str) -> tuple[Source, str]:
    """An arm with a file in the folder whose numbers are changed, and the change's name."""
    arm, name, random = drawn(seed, number, family)
    assert arm.file is not None
    tip = arm.links[arm.links.index("--tip") + 1] if "--tip" in arm.links else _last(arm.file)
    path = folder / f"{arm.file.stem}.urdf"
    text = arm.file.read_text(encoding="utf-8")
    path.write_text(perturbed(text, tip, CHANGES[name], random), encoding="utf-8")
    return replace(arm, file=path), name


def _last(path: Path) -> str:
    """The link with the most joints above it."""
    root = ET.parse(path).getroot()
    links = [link.get("name", "") for link in root.findall("link")]
    return max(links, key=lambda link: len(_above(root, link)))


def main(arguments: Sequence[str] | None = None) -> int:
    """Print a line an arm, and the table of those that failed."""
    layout = argparse.RawTextHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=layout)
    parser.add_argument("--family", default="", help="classes with this in their name alone")
    add_options(parser, count=100, poses=20_000, near=20_000)
    options = parser.parse_args(arguments)
    return soak_drawn(
        options, lambda number, folder: changed_arm(number, folder, options.seed, options.family)
    )


if __name__ == "__main__":
    sys.exit(main())
