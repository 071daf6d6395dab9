"""One file out of a shell and the runtime: what is used, once, under names of its own."""

from __future__ import annotations

import ast
import importlib
import re
from pathlib import Path

import numpy as np
import pytest
from tests.support.pan_lift import pan_lift
from tests.support.runtime_files import MODULES
from tests.support.solving import FIXTURES, import_text

from ikgen.derivation.derive import derive
from ikgen.emit.python.bundle import MARK, bundle
from ikgen.emit.python.docstrings import summary
from ikgen.emit.python.import_lines import External, import_lines
from ikgen.emit.python.python_emitter import emit_module
from ikgen.emit.python.runtime_source import PACKAGE, read_source, taken_apart
from ikgen.records.request import Request

pytestmark = pytest.mark.usefixtures("solved_once")

SHELL = f"""\"\"\"Turns.\"\"\"

from __future__ import annotations

from math import cos, pi

import numpy as np

from {PACKAGE}.arrays.rigid_motion import rotations_z as _turns

HALF = pi


{MARK}


def half_turn() -> object:
    return _turns(np.array(HALF))
"""


def test_what_is_used_comes_along(tmp_path: Path) -> None:
    text = bundle(SHELL)
    turns = import_text(text, tmp_path)
    assert np.allclose(turns.half_turn(), np.diag([-1.0, -1.0, 1.0, 1.0]))
    assert "def _turns(t: _Array)" in text and "inverses" not in text
    assert "_Array = NDArray[np.float64]" in text and "Row" not in text
    assert PACKAGE not in text and "import cos" not in text and MARK not in text
    assert '"""Rotations about z by t (...): (..., 4, 4)."""' in text
    assert text.startswith(
        '"""Turns."""\n\nfrom __future__ import annotations\n\nfrom math import pi\n'
    )


def test_details_of_private_documentation_stay_with_the_runtime() -> None:
    body = (
        'def turned(x: float) -> float:\n    """Say it.\n\n    And why.\n    """\n    return -x\n'
    )
    text = f'"""A module."""\n\n\n{body}'
    (turned,) = taken_apart("module", text).definitions
    assert turned.text({}) == text.partition("\n\n\n")[2].rstrip()
    short = turned.text({"turned": "_turned"})
    assert short == 'def _turned(x: float) -> float:\n    """Say it."""\n    return -x'


@pytest.mark.parametrize(
    ("text", "first"),
    [
        ("Rows (k, 6); the errors.", "Rows (k, 6)."),
        ("Poses at q\n(..., dof): (..., 4, 4); raises ValueError.", "Poses at q (..., dof): (..., 4, 4)."),
        ("The best: of all.", "The best."),
        ("`F_0; F_1 ... F_n`, a chain (one; two). It moves.", "`F_0; F_1 ... F_n`, a chain (one; two)."),
        ("No full stop", "No full stop"),
    ],
)  # fmt: skip
def test_what_a_docstring_says_first(text: str, first: str) -> None:
    assert summary(text) == first


def test_a_class_tells_what_its_members_are() -> None:
    assert summary("Ends: rows `q`; errors. More.", short=False) == "Ends: rows `q`; errors."


@pytest.mark.parametrize(
    "robot", ["kuka_kr6r900sixx", "doosan_m1013", "franka_fr3", "fanuc_crx10ia"]
)
def test_comments_of_a_module_name_what_it_has(robot: str) -> None:
    text = emit_module(derive(Request(FIXTURES / f"{robot}.urdf")).module)
    words = {
        getattr(node, field, None)
        for node in ast.walk(ast.parse(text))
        for field in ("id", "attr", "arg", "name")
    }
    assert set(re.findall(r"`(\w+)`", text)) <= words
    headings = re.findall(r"\n\n\n((?:# .*\n)+)\n\n", text)
    assert len(headings) > 20 and all(one.rstrip()[-1] in ".:" for one in headings)


CLASSES = '''"""A module."""


class Walk:
    """Goes."""

    def on(self) -> int:
        return self._step()

    def _step(self) -> int:
        return ONE

    # Back.
    def back(self) -> int:
        """Goes back; far."""
        return TWO

    @property
    def far(self) -> bool:
        return True


ONE, TWO = 1, 2
'''


def test_methods_that_are_not_called_stay_with_the_runtime() -> None:
    walk = taken_apart("module", CLASSES).definitions[0]
    assert [one.name for one in walk.members] == ["on", "_step", "back"]
    less = walk.without(one for one in walk.members if one.name == "back")
    assert less.text({}) == CLASSES.partition("\n\n\n")[2].partition("\n\n\nONE")[0].replace(
        CLASSES[CLASSES.index("\n    # Back") : CLASSES.index("\n    @property")], ""
    )
    assert less.uses == {"Walk", "int", "ONE", "bool", "property", "self"}


def test_methods_that_are_called_come_along(tmp_path: Path) -> None:
    shell = SHELL.replace(
        "arrays.rigid_motion import rotations_z as _turns", "solving.path_following import _Walk"
    )
    shell = shell.replace("_turns(np.array(HALF))", "_Walk._newton")
    text = bundle(shell)
    assert "def _newton(" in text and "def _motion(" in text  # which that calls
    assert "def go_on(" not in text and "def _unstopped(" not in text and "def __init__(" in text
    assert import_text(text, tmp_path).half_turn().__name__ == "_newton"


def test_the_same_text_each_time() -> None:
    assert bundle(SHELL) == bundle(SHELL)


def test_a_private_name_that_is_taken_gets_its_module_in_front(tmp_path: Path) -> None:
    text = bundle(SHELL + "\n\ndef _Array() -> None:\n    return None\n")
    assert "_array_types_Array = NDArray[np.float64]" in text and "def _Array() -> None" in text
    turns = import_text(text, tmp_path)
    assert np.allclose(turns.half_turn(), np.diag([-1.0, -1.0, 1.0, 1.0]))


def test_a_shell_that_defines_what_it_imports() -> None:
    with pytest.raises(ValueError, match="imported and defined: _turns"):
        bundle(SHELL + "\n\ndef _turns() -> None:\n    return None\n")


def test_a_name_that_the_runtime_lacks() -> None:
    with pytest.raises(ValueError, match="rigid_motion does not define rotations_w"):
        bundle(SHELL.replace("rotations_z", "rotations_w"))


def test_names_are_replaced_where_they_are_read() -> None:
    source = taken_apart(
        "it",
        'A = 1\n\n\n# of A\ndef f(x: int = A) -> int:\n    """`A`, not A."""\n    return A + x\n',
    )
    text = source.definitions[1].text({"A": "_B", "f": "_f"})
    assert text == '# of A\ndef _f(x: int = _B) -> int:\n    """`_B`, not A."""\n    return _B + x'


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("x = [1]\nx[0] = 2\n", "line 2: only definitions"),
        ("def f() -> None:\n    f = 1\n", "line 1: local names"),
        (
            "def f() -> None:\n    pass\n\n\ndef g(f: int) -> None:\n    pass\n",
            "line 5: local names",
        ),
    ],
)
def test_what_cannot_be_moved(text: str, complaint: str) -> None:
    with pytest.raises(ValueError, match=complaint):
        taken_apart("it", text)


@pytest.mark.parametrize("name", MODULES)
def test_modules_of_the_runtime_can_be_taken_apart(name: str) -> None:
    source = read_source(name)
    assert source.docstring
    module = importlib.import_module(f"{PACKAGE}.{name}")
    defined = {n for one in source.definitions for n in one.defines}
    assert set(module.__all__) <= defined


def test_imports_are_merged_and_sorted() -> None:
    given = "import numpy as np; from math import tau, pi; import os; from math import pi"
    nodes = [n for n in ast.parse(given).body if isinstance(n, ast.Import | ast.ImportFrom)]
    lines = import_lines([one for node in nodes for one in External.of(node)])
    assert lines == ["import os", "from math import pi, tau", "", "import numpy as np"]


def test_imports_of_the_package_itself_stay_relative() -> None:
    given = "from . import _native\nfrom ..arms import arm\nimport numpy as np"
    nodes = [n for n in ast.parse(given).body if isinstance(n, ast.Import | ast.ImportFrom)]
    lines = import_lines([one for node in nodes for one in External.of(node)])
    assert lines == ["import numpy as np", "", "from . import _native", "from ..arms import arm"]


def test_public_names_of_a_module_are_those_of_the_contract(tmp_path: Path) -> None:
    module = import_text(emit_module(pan_lift()), tmp_path)
    own = [
        n for n, v in vars(module).items() if getattr(v, "__module__", "") in ("", module.__name__)
    ]
    public = {name for name in own if not name.startswith("_")}
    assert public - {"a_2", "annotations", "np", "nan", "inf", "pi"} == set(module.__all__)


def test_an_emitted_module_needs_no_ikgen(tmp_path: Path) -> None:
    root = Path(__file__).resolve().parents[3]
    text = emit_module(derive(Request(root / "urdf_fixtures/ur5e.urdf")).module)
    imported = {n.module for n in ast.walk(ast.parse(text)) if isinstance(n, ast.ImportFrom)}
    assert not any((name or "").startswith("ikgen") for name in imported)
    arm = import_text(text, tmp_path)
    pose = arm.forward([0.3, -1.1, 1.4, 0.2, 0.9, -0.5])
    assert len(arm.solve(pose, limits=False)) == 8
