"""The chain on which Python refines many rows at once: its constants as text."""

from __future__ import annotations

from dataclasses import dataclass

from ikgen.emit.python.python_language import number
from ikgen.emit.solver_module import SolverModule
from ikgen.kinematics.rigid import exact_cos_sin
from ikgen.kinematics.twist_links import TwistLink, twist_chain
from ikgen.model.arrays import Array

__all__ = ["LaneText", "lane_text"]

Lines = tuple[tuple[str, ...], ...]


@dataclass(frozen=True, slots=True)
class LaneText:
    """The members of `LaneChain`; of `first` and `last` the upper rows."""

    first: Lines
    joint: tuple[int, ...]
    scale: tuple[str, ...]
    offset: tuple[str, ...]
    links: Lines
    last: Lines
    alike: bool


def lane_text(module: SolverModule) -> LaneText:
    """The file's own chain in twist form."""
    chain = twist_chain(module.dh)
    links = chain.links
    joint = tuple(link.driver for link in links)
    return LaneText(
        first=_rows(chain.first),
        joint=joint,
        scale=tuple(number(link.scale) for link in links),
        offset=tuple(number(link.offset) for link in links),
        links=tuple(map(_link, links)),
        last=_rows(chain.last),
        alike=joint == tuple(range(module.dh.dof)) and all(link.scale == 1.0 for link in links),
    )


def _rows(F: Array) -> Lines:
    return tuple(tuple(map(number, row)) for row in F[:3].tolist())


def _link(link: TwistLink) -> tuple[str, ...]:
    values = (*exact_cos_sin(link.turn), link.x, link.y, *exact_cos_sin(link.twist))
    return (str(link.revolute), *map(number, values))
