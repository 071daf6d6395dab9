"""From a description to the files of its map."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from ikgen.generation.derive import derive
from ikgen.generation.progress import Progress, silent
from ikgen.generation.publish import Content, check_folder, publish
from ikgen.generation.request import Request
from ikgen.processes.executors import Workers
from ikgen.reach.grid import grid_over
from ikgen.reach.reach_map import ReachMap, engine_of, reach_map
from ikgen.reach.slices_page import slices_page

__all__ = ["MapOrder", "write_map"]


@dataclass(frozen=True, slots=True)
class MapOrder:
    """How fine the grid is, what computes it, and the command that the page names."""

    cells: int
    directions: int
    rolls: int
    workers: Workers
    portable: bool
    command: str


def write_map(
    request: Request,
    order: MapOrder,
    out: Path,
    progress: Progress = silent,
    warn: Callable[[str], None] = lambda text: None,
    done: Callable[[int, int], None] = lambda ready, total: None,
) -> tuple[ReachMap, tuple[Path, ...]]:
    """The map and its files: the archive and the page."""
    check_folder(out)
    derivation = derive(request, progress)
    grid = grid_over(derivation.reading.dh, order.cells, order.directions, order.rolls)
    progress("compile", derivation.module.name)
    engine, size = engine_of(derivation, portable=order.portable, warn=warn)
    progress("map", f"{grid.poses:,} poses")
    found = reach_map(derivation, grid, engine, size, order.workers, done)
    name = derivation.module.name
    page = slices_page(found, order.command)
    files: dict[str, Content] = {f"{name}_reach.npz": found.archive(), f"{name}_reach.html": page}
    return found, publish(out, files)
