"""Solutions on what is a surface of the solved geometry and none of the file's."""

from __future__ import annotations

from types import ModuleType

import numpy as np
import pytest
from benchmarks.command_line import Emitted, emit, load_module
from benchmarks.soak import found_source, soak
from benchmarks.soak_counts import table
from numpy.typing import NDArray
from tests.support.remote_center import AT_THE_CENTER, REMOTE_CENTER
from tests.support.solving import NO_COMPILER

from ikgen.runtime.python.singular.meeting_rows import Ends, Leads, Led, Starts
from ikgen.runtime.python.singular.near_surface import on_surfaces

Array = NDArray[np.float64]
needs_compiler = pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER or "")


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Emitted:
    folder = tmp_path_factory.mktemp("surface")
    file = folder / "remote_center.urdf"
    file.write_text(REMOTE_CENTER)
    out = folder / "out"
    out.mkdir()
    return emit(found_source(str(file), ()), out)


@pytest.fixture(scope="module")
def module(made: Emitted) -> ModuleType:
    assert made.module is not None
    return load_module(made.module)


def apart(a: Array, b: Array) -> Array:
    return np.asarray(np.abs(np.remainder(a - b + np.pi, 2 * np.pi) - np.pi).max(axis=-1))


@pytest.mark.long
@needs_compiler
def test_headers_find_them(made: Emitted) -> None:
    found = soak(made, 0, 300, flags=("-O1",))
    assert sum(d[3] for d in found.decades) == 300
    assert found.failures(0.0) == 0, "\n".join(table(found))


def test_they_are_found_from_anywhere_on_the_surface(module: ModuleType) -> None:
    arm, q = module._ARM, np.array(AT_THE_CENTER)
    poses, none, pose = module.forward(q), np.zeros(len(q), dtype=np.int64), np.arange(len(q))
    start = q + np.array([0.9, 0.0, 0.0, 0.5])
    starts = Starts(start, poses, pose, none > 0, none, none)
    nowhere, nothing = np.zeros(len(q)), Led(none[:0], start[:0], np.zeros(0))
    found = on_surfaces(arm, Leads(starts, Ends(start, nowhere, nowhere), nothing, none > 0))
    assert (found.source == 0).all() and not found.marked.any()
    for i, at in enumerate(q):
        rows = found.q[found.pose == i]
        assert apart(rows, at).min() < 1e-3
        assert np.abs(arm.task.error(module.forward(rows), poses[[i]])).max() < 1e-9
        assert (apart(rows[:, None], rows[None]) + np.eye(len(rows)) > 9e-3).all(), "alike"


def test_where_one_direction_alone_is_flat_there_is_none(module: ModuleType) -> None:
    q, none = np.array([[0.3, 0.2, 0.05, 0.7]]), np.zeros(1, dtype=np.int64)
    starts = Starts(q, module.forward(q), none, none > 0, none, none)
    nothing = Led(none[:0], q[:0], np.zeros(0))
    leads = Leads(starts, Ends(q, np.zeros(1), np.zeros(1)), nothing, none > 0)
    assert not len(on_surfaces(module._ARM, leads).q)


def test_modules_find_them(module: ModuleType) -> None:
    for q in np.array(AT_THE_CENTER):
        assert apart(np.array(module.solve(module.forward(q)).q), q).min() < 1e-3
