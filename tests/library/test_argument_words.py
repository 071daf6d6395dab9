"""Errors and warnings name arguments of `ikgen.load`, not options of the command line."""

from __future__ import annotations

import ast
import inspect
import re
from pathlib import Path
from typing import Any

import pytest
from tests.support.solving import FIXTURES

import ikgen
from ikgen.errors import IkgenError
from ikgen.library.argument_words import ARGUMENTS, argument_words
from ikgen.records.option_words import PROSE

SOURCE = Path(ikgen.__file__).parent
UR5E, YUMI = FIXTURES / "ur5e.urdf", FIXTURES / "abb_yumi.urdf"


@pytest.mark.parametrize(
    ("typed", "written"),
    [
        ("by --base and --tip", "by base= and tip="),
        ("--base world --tip 'the tool'   6 joints", 'base="world", tip="the tool"   6 joints'),
        ("--free JOINT, or --task TASK", 'free="JOINT", or task="TASK"'),
        ("--free a --free b", 'free=["a", "b"]'),
        ("--free a=0.5 --free b: no", 'free={"a": 0.5, "b": None}: no'),
        ("--lock a=1e-3 --lock b=45deg", 'lock={"a": 1e-3, "b": "45deg"}'),
        ("--lock JOINT=VALUE instead", 'lock={"JOINT": VALUE} instead'),
        ("--couple: joint 'a'", "couple: joint 'a'"),
        ("--couple b=a*1+0 --couple c=a*1", 'couple={"b": "a*1+0", "c": "a*1"}'),
        ("--arg n:=v, --trust", 'args={"n": "v"}, trust=True'),
        ("--package-path DIR (--arg)", 'package_paths=["DIR"] (args=)'),
        ("leave the --lock out", "leave the lock= out"),
        ("--no-verify writes", "verify=False writes"),
        ("none: ikgen from-urdf 'a b.urdf'\nor", 'none: ikgen.load("a b.urdf")\nor'),
        ("ikgen from-dh a.toml --task position", 'ikgen.load("a.toml", task="position")'),
        ("write elsewhere with -o DIR, or --force; x --tips y", None),
    ],
)
def test_options_are_arguments(typed: str, written: str | None) -> None:
    assert argument_words(typed) == (typed if written is None else written)


def test_they_are_arguments_that_there_are() -> None:
    words = argument_words(" ".join(ARGUMENTS.options))
    assert set(re.findall(r"(\w+)=", words)) <= set(inspect.signature(ikgen.load).parameters)


def _texts(module: Path) -> list[str]:
    """The texts of a module that are no docstrings."""
    tree = ast.parse(module.read_text())
    docstrings = {id(one.value) for one in ast.walk(tree) if isinstance(one, ast.Expr)}
    constants = (one for one in ast.walk(tree) if isinstance(one, ast.Constant))
    return [
        one.value for one in constants if isinstance(one.value, str) and id(one) not in docstrings
    ]


def test_words_behind_options_are_known() -> None:
    pattern = re.compile(rf"(?:{'|'.join(ARGUMENTS.options)}) ([a-z]\w*)")
    modules = [path for path in SOURCE.rglob("*.py") if "cli" not in path.parts]
    behind = {word for path in modules for text in _texts(path) for word in pattern.findall(text)}
    assert behind == PROSE


@pytest.mark.parametrize(
    ("robot", "options", "hint"),
    [
        (YUMI, {}, 'base="yumi_base_link", tip="'),
        (UR5E, {"free": {"elbow_joint": 99.0}}, ""),
        (UR5E, {"lock": {"elbow_joint": 99.0}}, ""),
        (UR5E, {"base": "tool0", "tip": "base_link"}, "exchange base= and tip="),
        (UR5E, {"free": "arm-angle"}, 'lock={"JOINT": VALUE}'),
    ],
)
def test_errors_of_the_library_say_arguments(
    robot: Path, options: dict[str, Any], hint: str
) -> None:
    with pytest.raises(IkgenError) as caught:
        ikgen.load(robot, **options, verify=False, cache=False)
    assert hint in caught.value.hint and "--" not in str(caught.value)


def test_a_derivation_says_what_it_is_in_a_line() -> None:
    arm = ikgen.load(UR5E, verify=False, cache=False)
    assert repr(arm.derivation) == (
        f"<ikgen derivation of ur5e: {arm.derivation.geometry.name}, "
        f"{'; '.join(arm.derivation.order)}>"
    )
    assert len(repr(arm.derivation)) < 400
