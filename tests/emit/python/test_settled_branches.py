"""The runtime's text without what one arm never reaches: equal to the rest, and true of the arm."""

from __future__ import annotations

import ast
from functools import reduce
from importlib.resources import files
from pathlib import Path
from textwrap import indent

import pytest
from tests.support.redundant_arms import SHOULDER_ELBOW_WRIST, serial_urdf
from tests.support.runtime_files import MODULES
from tests.support.solving import FIXTURES, import_text

from ikgen.derivation.derive import derive
from ikgen.emit.python.python_emitter import emit_module, known_facts
from ikgen.emit.python.runtime_source import PACKAGE
from ikgen.emit.python.settled_branches import SOME, Facts, settled
from ikgen.records.request import Request

pytestmark = pytest.mark.usefixtures("solved_once")

TABLES = Path(__file__).resolve().parents[2] / "robots" / "tables"
REQUESTS = {
    "exact": Request(FIXTURES / "kuka_kr6r900sixx.urdf"),
    "held": Request(FIXTURES / "franka_fr3.urdf", free={"fr3_joint7": None}),
    "rounded": Request(FIXTURES / "doosan_m1013.urdf"),
    "eliminated": Request(TABLES / "KawasakiRS05L.toml"),
}

ROUNDED: Facts = (("rounded", True), ("around", SOME), ("angle", None), ("beside", SOME))
EXACT: Facts = (("rounded", False), ("around", None), ("angle", None), ("beside", ()))


@pytest.mark.parametrize(
    ("text", "rounded", "exact"),
    [
        ("x = a if arm.rounded else (b)", "x = a", "x = (b)"),
        ("x = f(\n    1\n    if arm.rounded\n    else 2\n)", "x = f(\n    1\n)", "x = f(\n    2\n)"),
        ("if not arm.rounded and f():\n    g()\nh()", "h()", "if f():\n    g()\nh()"),
        ("if (f() or g()) and arm.rounded:\n    g()\nh()", "if (f() or g()):\n    g()\nh()", "h()"),
        ("if f() or (arm.rounded and g()):\n    h()", "if f() or (g()):\n    h()", "if f():\n    h()"),
        ("if len(self.arm.beside) and x:\n    h()\ng()", "if x:\n    h()\ng()", "g()"),
        ("if len(arm.beside) == 6:\n    g()\nh()", None, "h()"),
        ("y = [k for k in z if k and arm.rounded]", "y = [k for k in z if k]", None),
        (
            "if f():\n    a()\nelif joint.arm.around is None:\n    # b\n    b()\nelse:\n    c()",
            "if f():\n    a()\nelse:\n    c()",
            "if f():\n    a()\nelse:\n    # b\n    b()",
        ),
        (
            "if arm.rounded:\n    a()\nelif f():\n    b()\n    b()",
            "a()",
            "if f():\n    b()\n    b()",
        ),
        (
            "def f():\n    if arm.rounded:\n        # why\n        return 1\n    x = 2\n    return x",
            "def f():\n    # why\n    return 1",
            "def f():\n    x = 2\n    return x",
        ),
        ("def f():\n    if arm.rounded:\n        g()", "def f():\n    g()", None),
        ("if other.rounded and arm.unknown:\n    arm.rounded = 1", None, None),
        ("x = arm.rounded and f()", None, None),  # what it is counts, not whether
        (
            "class Arm:\n    around: Around | None\n    angle: A | None = None",
            "class Arm:\n    around: Around\n    angle: None = None",
            "class Arm:\n    around: None\n    angle: None = None",
        ),
    ],
)  # fmt: skip
def test_what_is_left_of_conditions(text: str, rounded: str | None, exact: str | None) -> None:
    assert settled(defined(text), ROUNDED) == defined(text if rounded is None else rounded)
    assert settled(defined(text), EXACT) == defined(text if exact is None else exact)
    assert settled(defined(text), ()) == defined(text)


def defined(text: str) -> str:
    """A module with a function, or a class, of a text."""
    inside = text if text.startswith("class") else "def routine():\n" + indent(text, "    ")
    return f"import ast\n\n# above\n{inside}\n\n\ndef last():\n    pass\n"


@pytest.mark.parametrize("name", MODULES)
def test_an_arm_of_the_runtime_is_called_so(name: str) -> None:
    tree = ast.parse((files(PACKAGE) / f"{name.replace('.', '/')}.py").read_text(encoding="utf-8"))
    for node in ast.walk(tree):
        if isinstance(node, ast.arg) and node.arg.lstrip("_") == "arm":
            assert node.annotation is not None and ast.unparse(node.annotation) == "Arm"
        if isinstance(node, ast.AnnAssign) and ast.unparse(node.target).endswith("arm"):
            assert ast.unparse(node.annotation) == "Arm"


@pytest.mark.parametrize("kind", [*REQUESTS, "arm angle"])
def test_what_is_known_of_an_arm_is_true_of_it(kind: str, tmp_path: Path) -> None:
    robot = tmp_path / "arm.urdf"
    robot.write_text(serial_urdf("arm", SHOULDER_ELBOW_WRIST), encoding="utf-8")
    module = derive(REQUESTS.get(kind, Request(robot, free={"arm-angle": None}))).module
    arm = import_text(emit_module(module), tmp_path)._ARM
    for name, value in known_facts(module):
        given = reduce(getattr, name.split("."), arm)
        if value is None:
            assert given is None, name
        elif value is SOME or value == ():
            there = given is not None if callable(given) else len(given) > 0
            assert there is (value is SOME), name
        else:
            assert given == value, name
