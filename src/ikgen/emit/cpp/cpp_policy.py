"""The tolerances and counts of `solve` in C++."""

from __future__ import annotations

import dataclasses
import re

from ikgen.emit.cpp.cpp_language import declared, number
from ikgen.program.policy import RefineStage, SolvePolicy

__all__ = ["policy_lines"]


def policy_lines(policy: SolvePolicy, text: str) -> list[str]:
    """Members of `struct Policy`: those that the text reads as `Policy::kName`."""
    read = set(re.findall(r"\bPolicy::(k\w+)", text))
    values = [(_constant(f.name), getattr(policy, f.name)) for f in dataclasses.fields(policy)]
    used = [(name, value) for name, value in values if name in read]
    counts = [(name, str(value)) for name, value in used if isinstance(value, int)]
    numbers = [(name, number(value)) for name, value in used if isinstance(value, float)]
    stages = [
        line for name, value in used if isinstance(value, tuple) for line in _stages(name, value)
    ]
    return [
        *declared("static constexpr int", counts),
        *declared("static constexpr double", numbers),
        *stages,
    ]


def _constant(name: str) -> str:
    return "k" + "".join(part.capitalize() for part in name.split("_"))


def _stages(name: str, stages: tuple[RefineStage, ...]) -> list[str]:
    rows = (f"{{{s.steps}, {number(s.fine)}, {number(s.promising)}}}" for s in stages)
    return [f"static constexpr RefineStage {name}[] = {{{', '.join(rows)}}};"]
