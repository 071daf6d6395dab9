"""Maps as files: what is written is read again, by NumPy and by zarr, and by the viewer."""

from __future__ import annotations

import io
import shlex
import sys
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from ikgen.cli.main import run
from ikgen.derivation.derive import derive
from ikgen.errors import BadDescriptionError, MissingToolError
from ikgen.reach.grid import grid_over
from ikgen.reach.reach_map import ReachMap, interpreted_engine, reach_map
from ikgen.reach.stored_map import archive, map_contents, read_map, zarr_files
from ikgen.records.request import Request

pytestmark = pytest.mark.usefixtures("solved_once")

TABLE = Path(__file__).resolve().parents[2] / "urdf_fixtures/scara_standard.toml"


@cache
def small() -> ReachMap:
    derivation = derive(Request(TABLE))
    engine = interpreted_engine(derivation)
    grid = grid_over(derivation.reading.dh, 6, 2, 1)
    return reach_map(derivation, grid, engine, engine.size, None)


def same(one: ReachMap, other: ReachMap) -> bool:
    """Whether maps are equal to the byte, coordinates and facts too."""
    return archive(one) == archive(other)


def test_the_archive_has_arrays_with_coordinates() -> None:
    found = small()
    with np.load(io.BytesIO(archive(found))) as data:
        assert data["count"].shape == tuple(len(data[n]) for n in ("x", "y", "z", "rotations"))
        assert str(data["tip"]) == found.tip and float(data["size"]) == found.size
        assert data["sigma"].dtype == np.float32


def test_an_archive_is_read_again(tmp_path: Path) -> None:
    (tmp_path / "map.npz").write_bytes(archive(small()))
    assert same(read_map(tmp_path / "map.npz"), small())


def test_a_zarr_group_is_read_again_and_names_its_dimensions(tmp_path: Path) -> None:
    zarr = pytest.importorskip("zarr")
    assert zarr_files(small()) == zarr_files(small())
    for path, content in map_contents(small(), "map", ".zarr").items():
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).write_bytes(content if isinstance(content, bytes) else content.encode())
    assert same(read_map(tmp_path / "map.zarr"), small())
    group = zarr.open_group(tmp_path / "map.zarr", mode="r")
    assert group["count"].metadata.dimension_names == ("x", "y", "z", "rotation")
    assert group["x"].metadata.dimension_names == ("x",)


@pytest.mark.parametrize("text", [b"", b"no archive", b"PK"])
def test_what_is_no_map_is_told(text: bytes, tmp_path: Path) -> None:
    (tmp_path / "map.npz").write_bytes(text)
    with pytest.raises(BadDescriptionError, match="not a map"):
        read_map(tmp_path / "map.npz")
    with pytest.raises(BadDescriptionError, match=r"nothing\.npz: no such file"):
        read_map(tmp_path / "nothing.npz")
    np.savez(tmp_path / "other.npz", a=np.zeros(3))
    with pytest.raises(BadDescriptionError, match="not a map"):
        read_map(tmp_path / "other.npz")
    np.save(tmp_path / "array.npy", np.zeros(3))
    with pytest.raises(BadDescriptionError, match=r"array\.npy: not a map: an array alone"):
        read_map(tmp_path / "array.npy")
    pytest.importorskip("zarr")
    with pytest.raises(BadDescriptionError, match="not a map"):
        read_map(tmp_path)


def test_zarr_is_asked_for_where_it_lacks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "zarr", None)
    with pytest.raises(MissingToolError, match="zarr") as caught:
        zarr_files(small())
    assert "ikgen[zarr]" in caught.value.hint


COMMAND = ["reach", str(TABLE), "--directions", "2", "--workers", "1", "-q"]


@pytest.mark.long
def test_the_command_writes_both_files(tmp_path: Path) -> None:
    assert run([*COMMAND, "--cells", "6", "-o", str(tmp_path)]) == 0
    assert sorted(p.suffix for p in tmp_path.iterdir()) == [".html", ".json", ".npz"]


def without_compiler(*_: object, **__: object) -> None:
    raise MissingToolError("no compiler", hint="none is needed")


def test_the_command_writes_the_file_that_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("zarr")
    monkeypatch.setattr("ikgen.reach.reach_map.compiled_engine", without_compiler)
    store = tmp_path / "maps/mine.zarr"
    command = [*COMMAND, "-o", str(store)]
    assert run([*command, "--cells", "90"]) == 0
    old = store / "sigma/c/1/0/0/0"
    assert old.is_file()
    assert run([*command, "--cells", "6"]) == 0  # nothing of the larger one is left
    assert not old.exists() and sorted(p.name for p in store.parent.iterdir()) == [
        "mine.html", "mine.json", "mine.zarr",
    ]  # fmt: skip
    assert same(read_map(store), small())
    (store / "notes.txt").write_text("mine")
    capsys.readouterr()
    assert run([*command, "--cells", "6"]) == 2
    assert "notes.txt is in no record of ikgen" in capsys.readouterr().err
    assert run([*command, "--cells", "6", "--force"]) == 0
    assert not (store / "notes.txt").exists()
    assert run([*command, "--cells", "6", "--json"]) == 0
    assert str(store) in capsys.readouterr().out


@pytest.mark.parametrize("chosen", [[], ["--task", "position", "--lock", "flange=0.5"]])
def test_the_page_has_the_command_that_makes_it_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, chosen: list[str]
) -> None:
    monkeypatch.setattr("ikgen.reach.reach_map.compiled_engine", without_compiler)
    assert run([*COMMAND, "--cells", "3", *chosen, "-o", str(tmp_path)]) == 0
    page = (tmp_path / "scara_reach.html").read_text(encoding="utf-8")
    fineness = "--cells 3 --directions 2 --rolls 1"
    words = ["ikgen", "reach", TABLE.name, *chosen, *fineness.split()]
    assert f"<dd>{shlex.join(words)}</dd>" in page
