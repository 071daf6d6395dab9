"""From a description to the files of its map."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from ikgen.derivation.derive import derive
from ikgen.derivation.progress import Progress, silent
from ikgen.outputs.publish import check_folder
from ikgen.outputs.written_list import publish_listed
from ikgen.processes.executors import Workers
from ikgen.reach.grid import grid_over
from ikgen.reach.reach_map import ReachMap, engine_of, reach_map
from ikgen.reach.slices_page import slices_page
from ikgen.reach.stored_map import FORMATS, check_format, map_contents
from ikgen.records.request import Request

__all__ = ["MapOrder", "write_map"]


@dataclass(frozen=True, slots=True)
class MapOrder:
    """How fine the grid is, what computes it, the command that the page names, and whether files that
    ikgen did not write, or that were edited, may be replaced."""

    cells: int
    directions: int
    rolls: int
    workers: Workers
    portable: bool
    command: str
    force: bool = False


def write_map(
    request: Request,
    order: MapOrder,
    out: Path,
    progress: Progress = silent,
    warn: Callable[[str], None] = lambda text: None,
    done: Callable[[int, int], None] = lambda ready, total: None,
) -> tuple[ReachMap, tuple[Path, ...]]:
    """The map and its files: the arrays and the page. `out` is a folder, or names the file (`FORMATS`).
    Raises `UsageError` where files that ikgen did not write, or that were edited, would be replaced."""
    check_folder(out.parent if out.suffix in FORMATS else out)
    check_format(out.suffix)
    derivation = derive(request, progress)
    grid = grid_over(derivation.reading.dh, order.cells, order.directions, order.rolls)
    progress("compile", derivation.module.name)
    engine, size = engine_of(derivation, portable=order.portable, warn=warn)
    progress("map", f"{grid.poses:,} poses")
    found = reach_map(derivation, grid, engine, size, order.workers, done)
    return found, _written(found, out, f"{derivation.module.name}_reach", order)


def _written(found: ReachMap, out: Path, name: str, order: MapOrder) -> tuple[Path, ...]:
    """The map and its page: in a folder by `name`, or as a file that `out` names, its page beside it."""
    folder, suffix = out, ".npz"
    if out.suffix in FORMATS:
        folder, name, suffix = out.parent, out.stem, out.suffix
    files = map_contents(found, name, suffix)
    files[f"{name}.html"] = slices_page(found, order.command)
    store = folder / f"{name}{suffix}"
    earlier = [path for path in store.rglob("*") if path.is_file()] if store.is_dir() else []
    new = {folder / path for path in files}
    gone = [path for path in earlier if path not in new]
    publish_listed(folder, name, files, gone, force=order.force)
    return store, folder / f"{name}.html"
