"""The tolerances and counts of `solve` in C++."""

from __future__ import annotations

import dataclasses
import re

from ikgen.emit.cpp.cpp_language import number
from ikgen.program.policy import RefineStage, SolvePolicy

__all__ = ["policy_lines"]


def policy_lines(policy: SolvePolicy, text: str) -> list[str]:
    """Members of `struct Policy`: those that the text reads as `Policy::kName`."""
    read = set(re.findall(r"\bPolicy::(k\w+)", text))
    values = [(_constant(f.name), getattr(policy, f.name)) for f in dataclasses.fields(policy)]
    return [_member(name, value) for name, value in values if name in read]


def _constant(name: str) -> str:
    return "k" + "".join(part.capitalize() for part in name.split("_"))


def _member(name: str, value: float | int | tuple[RefineStage, ...]) -> str:
    if isinstance(value, tuple):
        rows = (f"{{{s.steps}, {number(s.fine)}, {number(s.promising)}}}" for s in value)
        return f"static constexpr RefineStage {name}[] = {{{', '.join(rows)}}};"
    if isinstance(value, int):
        return f"static constexpr int {name} = {value};"
    return f"static constexpr double {name} = {number(value)};"
