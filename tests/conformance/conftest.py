"""Compiled MoveIt plugins, once a run."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.support.moveit_arms import Arm, compiled_arm, missing_tools, running
from tests.support.moveit_driver import Plugin


@pytest.fixture(scope="session")
def moveit_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One folder a run, whichever worker of pytest-xdist asks."""
    own = tmp_path_factory.getbasetemp()
    folder = (own.parent if "PYTEST_XDIST_WORKER" in os.environ else own) / "moveit"
    folder.mkdir(exist_ok=True)
    return folder


@pytest.fixture
def arm(request: pytest.FixtureRequest, moveit_folder: Path) -> Arm:
    if missing := missing_tools("g++"):
        pytest.skip(missing)
    return compiled_arm(request.param, moveit_folder)


@pytest.fixture
def plugin(arm: Arm) -> Iterator[Plugin]:
    """The plugin over the arm's own tree; not yet initialized."""
    with running(arm) as plugin:
        yield plugin
