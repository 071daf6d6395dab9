"""The chain on which C++ refines rows in lanes: its constants as braced lists."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from ikgen.emit.cpp.cpp_language import number
from ikgen.emit.solver_module import SolverModule
from ikgen.emit.twist_numbers import LinkNumbers, twist_numbers

__all__ = ["TwistLines", "twist_lines"]


@dataclass(frozen=True, slots=True)
class TwistLines:
    """`first`, `last`: upper rows of the frames at the ends; `links`: members of `Link` in its order."""

    first: tuple[str, ...]
    links: tuple[str, ...]
    last: tuple[str, ...]


def twist_lines(module: SolverModule) -> TwistLines:
    """Braced lists of the file's own chain in twist form."""
    numbers = twist_numbers(module, number)
    first, last = (tuple(map(_braced, rows)) for rows in (numbers.first, numbers.last))
    return TwistLines(first, tuple(map(_link, numbers.links)), last)


def _link(link: LinkNumbers) -> str:
    turning = "true" if link.revolute else "false"
    return _braced([str(link.driver), turning, link.scale, link.offset, *link.constants])


def _braced(parts: Iterable[str]) -> str:
    return "{" + ", ".join(parts) + "}"
