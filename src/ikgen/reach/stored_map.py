"""Maps as files: an .npz archive, or a zarr group that reads in parts; both with their coordinates."""

from __future__ import annotations

import io
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.lib.npyio import NpzFile

from ikgen.errors import BadDescriptionError, MissingToolError
from ikgen.outputs.publish import Content
from ikgen.reach.grid import Grid
from ikgen.reach.reach_map import ReachMap

__all__ = ["FORMATS", "archive", "check_format", "map_contents", "read_map", "zarr_files"]

FORMATS = (".npz", ".zarr")

_TEXTS = ("robot", "base", "tip", "task")
_COORDINATES = {"x": ("x",), "y": ("y",), "z": ("z",), "rotations": ("rotation", "row", "column")}
_VALUES = ("count", "sigma", "margin")
_DIMENSIONS = ("x", "y", "z", "rotation")
_CHUNK = 64
"""Positions along each axis that a piece of a zarr array has at most; all their rotations go with them."""


def check_format(suffix: str) -> None:
    """Raises `MissingToolError` where maps of a format cannot be written here."""
    if suffix == ".zarr":
        _zarr()


def map_contents(found: ReachMap, name: str, suffix: str) -> dict[str, Content]:
    """File name -> content of the map in one of `FORMATS`; equal maps give equal bytes."""
    if suffix == ".zarr":
        return {f"{name}.zarr/{path}": data for path, data in zarr_files(found).items()}
    return {f"{name}.npz": archive(found)}


def archive(found: ReachMap) -> bytes:
    """An .npz: the arrays and their coordinates."""
    stream = io.BytesIO()
    texts: dict[str, Any] = {n: np.array(getattr(found, n)) for n in (*_TEXTS, "size")}
    np.savez(stream, **_arrays(found), **texts)
    return stream.getvalue()


def _arrays(found: ReachMap) -> dict[str, Any]:
    values: dict[str, Any] = {n: getattr(found, n) for n in _VALUES}
    return values | {n: getattr(found.grid, n) for n in _COORDINATES}


def zarr_files(found: ReachMap) -> dict[str, bytes]:
    """Path in the store -> bytes of a zarr group (format 3) whose arrays name their dimensions. Raises
    `MissingToolError` where zarr is not installed."""
    zarr = _zarr()
    held: dict[str, Any] = {}
    group = zarr.create_group(store=zarr.storage.MemoryStore(held), zarr_format=3)
    group.attrs.update({n: getattr(found, n) for n in (*_TEXTS, "size")})
    for name, values in _arrays(found).items():
        chunks = tuple(min(n, _CHUNK) for n in values.shape[:3]) + values.shape[3:]
        array = group.create_array(
            name,
            shape=values.shape,
            dtype=values.dtype,
            chunks=chunks,
            dimension_names=_COORDINATES.get(name, _DIMENSIONS),
        )
        array[...] = values
    return {path: held[path].to_bytes() for path in sorted(held)}


def read_map(path: Path) -> ReachMap:
    """The map of an .npz or a zarr group; raises `BadDescriptionError` for what is none."""
    if not path.exists():
        raise BadDescriptionError("no such file", file=str(path), hint="make one by ikgen reach")
    try:
        return _by_zarr(path) if path.is_dir() else _by_numpy(path)
    except (OSError, EOFError, KeyError, ValueError, zipfile.BadZipFile) as error:
        raise BadDescriptionError(
            f"not a map: {error}", file=str(path), hint="make one by ikgen reach"
        ) from None


def _by_numpy(path: Path) -> ReachMap:
    data = np.load(path)
    if not isinstance(data, NpzFile):
        raise ValueError("an array alone")
    with data:
        return _map(data, data)


def _by_zarr(path: Path) -> ReachMap:
    group = _zarr().open_group(path, mode="r")
    return _map(group.attrs, group)


def _map(facts: Any, arrays: Any) -> ReachMap:
    """The map of its texts and arrays by name."""
    texts: dict[str, Any] = {n: str(facts[n]) for n in _TEXTS}
    values: dict[str, Any] = {n: np.asarray(arrays[n]) for n in _VALUES}
    grid = Grid(*(np.asarray(arrays[n]) for n in _COORDINATES))
    return ReachMap(**texts, **values, grid=grid, size=float(facts["size"]))


def _zarr() -> Any:
    try:
        import zarr
    except ImportError as error:
        hint = "pip install 'ikgen[zarr]'"
        raise MissingToolError("maps in zarr need the package zarr", hint=hint) from error
    return zarr
