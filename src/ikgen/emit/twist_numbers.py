"""The file's own chain in twist form, on which many rows are refined at once: its constants as text."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ikgen.emit.solver_module import SolverModule
from ikgen.kinematics.rigid import exact_cos_sin
from ikgen.kinematics.twist_links import TwistLink, twist_chain
from ikgen.model.arrays import Array

__all__ = ["LinkNumbers", "TwistNumbers", "twist_numbers"]

Number = Callable[[float], str]
Lines = tuple[tuple[str, ...], ...]


@dataclass(frozen=True, slots=True)
class LinkNumbers:
    """What a `TwistLink` holds; `constants` are cosine and sine of a slide's turn, x, y, cosine and sine of
    the twist."""

    driver: int
    revolute: bool
    scale: str
    offset: str
    constants: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class TwistNumbers:
    """`first`, `last`: upper rows of the frames at the ends. `direct`: whether there is a link for each
    joint, in order, with the scale 1."""

    first: Lines
    links: tuple[LinkNumbers, ...]
    last: Lines
    direct: bool


def twist_numbers(module: SolverModule, number: Number) -> TwistNumbers:
    """The numbers of the chain as the language writes them."""
    chain = twist_chain(module.dh)
    links = chain.links
    drivers = [link.driver for link in links]
    return TwistNumbers(
        _rows(chain.first, number),
        tuple(_link(link, number) for link in links),
        _rows(chain.last, number),
        drivers == list(range(module.dh.dof)) and all(link.scale == 1.0 for link in links),
    )


def _rows(F: Array, number: Number) -> Lines:
    return tuple(tuple(map(number, row)) for row in F[:3].tolist())


def _link(link: TwistLink, number: Number) -> LinkNumbers:
    values = (*exact_cos_sin(link.turn), link.x, link.y, *exact_cos_sin(link.twist))
    scale, offset = number(link.scale), number(link.offset)
    return LinkNumbers(link.driver, link.revolute, scale, offset, tuple(map(number, values)))
