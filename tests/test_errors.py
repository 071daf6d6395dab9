"""Errors for people: what they list."""

from __future__ import annotations

import ast
from pathlib import Path

import ikgen
from ikgen.errors import UnknownNameError


def test_the_closest_names_come_first_and_long_lists_are_cut():
    error = UnknownNameError("link", "tol0", ["base", "flange", "tool0"])
    assert error.hint == "there is: tool0, base, flange"
    joints = UnknownNameError("joint", "a9", ["a3", "a1", "wrist", "a2", "a4"])
    assert joints.hint == "there is: a3, a1, a2, wrist, a4", "those alike in the order given"
    many = UnknownNameError("link", "tol0", [*(f"l{i}" for i in range(10_000)), "tool0"])
    assert many.hint.startswith("there is: tool0, ") and many.hint.endswith(", and 9901 more")
    assert len(many.known) == 10_001


def test_every_refusal_names_a_way_out() -> None:
    """Errors that list what there is name it themselves."""
    names = {"UsageError", "ArgumentError", "BadDescriptionError", "UnsupportedJointError",
             "MissingToolError", "PlugInError"}  # fmt: skip
    without = []
    for path in sorted(Path(ikgen.__file__).parent.rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
                given = {keyword.arg for keyword in node.keywords}
                if node.func.id in names and not given & {"hint", None}:
                    without.append(f"{path.name}:{node.lineno}: {node.func.id}")
    assert not without
