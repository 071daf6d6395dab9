"""Where in a document the step of an unknown is."""

from __future__ import annotations

from ikgen.equations.knowledge import Variable

__all__ = ["step_anchor"]


def step_anchor(v: Variable) -> str:
    """The place of an unknown's step, for links: signs and digits of the joints in its sum."""
    signs = {1: "", -1: "m"}
    parts = [f"{signs.get(k, f'x{k}')}{j + 1}" for j, k in enumerate(v.combination) if k]
    return f"step-{v.kind}-{'-'.join(parts)}"
