"""Errors for people: what they list."""

from __future__ import annotations

from ikgen.errors import UnknownNameError


def test_the_closest_names_come_first_and_long_lists_are_cut():
    error = UnknownNameError("link", "tol0", ["base", "flange", "tool0"])
    assert error.hint == "there is: tool0, base, flange"
    many = UnknownNameError("link", "tol0", [*(f"l{i}" for i in range(10_000)), "tool0"])
    assert many.hint.startswith("there is: tool0, ") and many.hint.endswith(", and 9901 more")
    assert len(many.known) == 10_001
