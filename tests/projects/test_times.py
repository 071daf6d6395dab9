"""Builds are as fast as `benchmarks/builds.py` says they have to be."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import pytest

from benchmarks import builds

IDLE = 0.8
ONE_CHECKED = 0.2
"""Seconds in which an arm is seen to be fresh: a step of every build."""


def processor_seconds(*arguments: str, cwd: Path) -> float:
    """What one `ikgen` command takes of the processor: other processes do not lengthen that."""
    resource = pytest.importorskip("resource", reason="needs the times of child processes")
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    builds.seconds(*arguments, cwd=cwd)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return float(after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime)


def test_fresh_arms_are_checked_at_once(tmp_path: Path) -> None:
    config = builds.write_config(tmp_path, 1, 20)
    builds.seconds("build", "--no-verify", "-q", cwd=tmp_path)
    check = ("build", "--check", "--no-verify")
    assert min(processor_seconds(*check, cwd=tmp_path) for _ in range(5)) < ONE_CHECKED
    table = config.read_text()
    tables = [table.replace('"generated"', f'"generated_{i}"') for i in range(50)]
    for i in range(50):
        shutil.copytree(tmp_path / "generated", tmp_path / f"generated_{i}")
    config.write_text("\n".join(tables))
    taken = min(processor_seconds(*check, cwd=tmp_path) for _ in range(5))
    assert taken < builds.CHECK_SECONDS


@pytest.mark.slow
@pytest.mark.skipif((os.cpu_count() or 1) < 2, reason="needs two cores")
def test_a_build_on_two_cores_beats_single_runs(tmp_path: Path) -> None:
    if os.getloadavg()[0] > IDLE:
        pytest.skip("needs an idle machine: two processes are to share it")
    times = builds.measure(tmp_path, arms=10, checked=1, samples=1000, jobs=2)
    assert times.share <= builds.BUILD_SHARE
