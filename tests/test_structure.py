"""What keeps the source readable: short modules and functions, names that stand once, types."""

from __future__ import annotations

import ast
import re
import statistics
from collections import Counter
from collections.abc import Iterable, Iterator
from configparser import ConfigParser
from itertools import groupby
from pathlib import Path

import pytest

from ikgen.emit.cpp.cpp_definitions import Definition, definitions
from ikgen.emit.cpp.header_bundle import RUNTIME

ROOT = Path(__file__).resolve().parents[1]
SOURCE = ROOT / "src" / "ikgen"
MODULES = sorted(p for p in SOURCE.rglob("*.py") if p.name != "__init__.py")
Function = ast.FunctionDef | ast.AsyncFunctionDef


def functions(path: Path) -> list[Function]:
    tree = ast.parse(path.read_text(encoding="utf-8"))
    return [node for node in ast.walk(tree) if isinstance(node, Function)]


def lines(path: Path) -> int:
    return len(path.read_text(encoding="utf-8").splitlines())


def test_modules_are_short() -> None:
    assert statistics.median(lines(path) for path in MODULES) <= 110


@pytest.mark.parametrize("folder", ["src/ikgen", "templates"])
def test_no_file_is_long(folder: str) -> None:
    kinds = (".py", ".hpp", ".cpp", ".jinja", ".cmake", ".in")
    files = [p for p in (ROOT / folder).rglob("*") if p.suffix in kinds]
    assert files
    assert {p.name: lines(p) for p in files if lines(p) > 300} == {}


def test_functions_are_short() -> None:
    found = [(f.end_lineno or 0) - f.lineno + 1 for path in MODULES for f in functions(path)]
    assert statistics.quantiles(found, n=10)[-1] <= 25
    assert max(found) <= 50


def cpp_functions(found: Iterable[Definition]) -> Iterator[tuple[str, int]]:
    """Names and lengths of functions, constructors and operators, and of whatever has no members."""
    for one in found:
        yield from cpp_functions(one.members)
        if not one.members and (text := one.text.strip()):
            yield text.splitlines()[0], len(text.splitlines())


def test_functions_of_the_cpp_runtime_are_short() -> None:
    unnamed = re.compile(r"^(?:namespace \{|\}  // namespace)\n", re.MULTILINE)
    inner = re.compile(r"\nnamespace \w+ \{\n(.*)\}  // namespace", re.DOTALL)
    files = RUNTIME.parent.rglob("*.[ch]pp")
    texts = [inner.search(unnamed.sub("", path.read_text(encoding="utf-8"))) for path in files]
    found = [one for text in texts if text for one in cpp_functions(definitions(text[1]))]
    assert len(found) > 1000
    assert statistics.quantiles((lines for _, lines in found), n=10)[-1] <= 25
    assert [(name, lines) for name, lines in found if lines > 50] == []


def test_templates_hold_little_that_is_the_same_for_all_arms() -> None:
    """What holds no Jinja is a source file, compiled and tested by itself, or a few lines of shape."""
    longest = {}
    for path in [*(ROOT / "templates").rglob("*.jinja"), *(ROOT / "examples").rglob("*.jinja")]:
        lines = path.read_text(encoding="utf-8").splitlines()
        plain = (not re.search(r"\{[{%#]", line) for line in lines)
        runs = [sum(1 for _ in run) for same, run in groupby(plain) if same]
        longest[path.name] = max(runs, default=0)
    assert len(longest) > 40
    assert {name: lines for name, lines in longest.items() if lines > 29} == {}


def test_headers_include_what_the_layers_of_their_folders_allow() -> None:
    contracts = ConfigParser()
    contracts.read(ROOT / ".importlinter", encoding="utf-8")
    contract = contracts["importlinter:contract:runtime"]
    layers = [name.strip("()") for name in contract["layers"].split()]
    up = [
        f"{path.parent.name}/{path.name}: {folder}"
        for path in RUNTIME.rglob("*.hpp")
        for folder in re.findall(r'#include "(\w+)/', path.read_text(encoding="utf-8"))
        if layers.index(folder) < layers.index(path.parent.name)
    ]
    assert up == [] and {path.name for path in RUNTIME.iterdir()} == set(layers)


def test_what_one_folder_imports_all_others_are_forbidden() -> None:
    contracts = ConfigParser()
    contracts.read(ROOT / ".importlinter", encoding="utf-8")
    forbidden = [c for c in contracts.values() if c.get("type") == "forbidden"]
    folders = {f"ikgen.{path.parent.name}" for path in SOURCE.glob("*/__init__.py")}
    assert len(forbidden) == 5 and len(folders) > 20
    for contract in forbidden:
        owner = contract["name"].rpartition(" only in ")[2]
        listed = contract["source_modules"].split()
        assert sorted(listed) == sorted(folders - {f"ikgen.{owner}"}), contract["name"]


def test_comments_of_constants_stand_alone() -> None:
    """Emitted code has those constants alone that it needs: what is said of the one before may be gone."""
    goes_on = re.compile(r"\S.* (?:#|//) (?:and|or|the same)\b")
    files = [p for p in (SOURCE / "runtime").rglob("*.*") if p.suffix in (".py", ".hpp")]
    found = [line for p in files for line in p.read_text(encoding="utf-8").splitlines()]
    assert len(found) > 10000 and [line for line in found if goes_on.match(line)] == []


def test_docstrings_can_be_read_alone() -> None:
    starts = (
        "Of ",
        "Those ",
        "That of ",
        "The same of ",
        "The same for ",
        "The same with ",
        "The same as ",
    )
    kinds = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)
    for path in MODULES:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            words = ast.get_docstring(node) or "" if isinstance(node, kinds) else ""
            assert not words.startswith(starts), f"{path.name}:{node.name}: {words}"


def test_no_module_has_the_name_of_another() -> None:
    names = Counter(path.name for path in [*MODULES, *RUNTIME.rglob("*.hpp")])
    names += Counter(
        path.name
        for path in (ROOT / "templates").glob("*/*.py.jinja")
        if not path.name.startswith("_")
    )
    assert [name for name, count in names.items() if count > 1] == []


def test_everything_is_typed() -> None:
    bare = []
    for path in SOURCE.rglob("*.py"):
        for f in functions(path):
            given = [*f.args.posonlyargs, *f.args.args, *f.args.kwonlyargs]
            untyped = [
                a.arg for a in given if a.annotation is None and a.arg not in ("self", "cls")
            ]
            if untyped or f.returns is None:
                bare.append(f"{path.relative_to(ROOT)}:{f.lineno} {f.name}")
    assert bare == []
