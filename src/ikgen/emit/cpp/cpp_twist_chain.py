"""The chain on which C++ refines rows in lanes: its constants as text."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from ikgen.emit.cpp.cpp_language import number
from ikgen.emit.solver_module import SolverModule
from ikgen.kinematics.rigid import exact_cos_sin
from ikgen.kinematics.twist_links import TwistLink, twist_chain
from ikgen.model.arrays import Array

__all__ = ["TwistLines", "twist_lines"]


@dataclass(frozen=True, slots=True)
class TwistLines:
    """`first`, `last`: upper rows of the frames at the ends; `links`: members of `Link` in its order."""

    first: tuple[str, ...]
    links: tuple[str, ...]
    last: tuple[str, ...]


def twist_lines(module: SolverModule) -> TwistLines:
    """Braced lists of the file's own chain in twist form."""
    chain = twist_chain(module.dh)
    links = tuple(map(_link, chain.links))
    return TwistLines(_rows(chain.first), links, _rows(chain.last))


def _rows(F: Array) -> tuple[str, ...]:
    return tuple(_braced(map(number, row)) for row in F[:3].tolist())


def _link(link: TwistLink) -> str:
    values = (
        link.scale, link.offset, *exact_cos_sin(link.turn), link.x, link.y, *exact_cos_sin(link.twist)
    )  # fmt: skip
    turning = "true" if link.revolute else "false"
    return _braced([str(link.driver), turning, *map(number, values)])


def _braced(parts: Iterable[str]) -> str:
    return "{" + ", ".join(parts) + "}"
