"""A sample of planted defects; the whole is `python -m benchmarks.planted`."""

from __future__ import annotations

from benchmarks.command_line import FIXTURES
from benchmarks.planted import unfound


def test_verification_finds_them() -> None:
    left, count = unfound(FIXTURES / "kuka_kr6r900sixx.urdf", every=10)
    assert left == [] and count >= 5
