"""`ikgen doctor`: which tools there are, and how to get the others."""

from __future__ import annotations

import json
import shutil
import sys
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import click

from ikgen import __version__
from ikgen.cli.tables import table

__all__ = ["doctor"]

_PACKAGES = (
    ("numpy", "needed"),
    ("sympy", "needed"),
    ("jinja2", "needed"),
    ("click", "needed"),
    ("rich", "needed"),
    ("py_trees", "needed"),
    ("yourdfpy", "reads URDF"),
    ("xacro", "expands xacro files"),
    ("pin", "Pinocchio: verifies"),
)
_TOOLS = (
    ("g++", "compiles the C++ header for its verification: install a C++17 compiler"),
    ("clang++", "the same, instead of g++"),
    ("cmake", "runs ikgen_generate(): install cmake"),
    ("pdflatex", "turns the LaTeX report into a PDF: install texlive-latex-base"),
    ("dot", "not needed: graphs are also written as text"),
)


def _package(name: str) -> str | None:
    try:
        return version(name)
    except PackageNotFoundError:
        return None


def _eigen() -> str | None:
    """Where Eigen's headers are: the system's, or those of the package cmeel-eigen."""
    places = [Path("/usr/include/eigen3"), Path("/usr/local/include/eigen3")]
    places.append(Path(sys.prefix, "include/eigen3"))
    places += [Path(p, "cmeel.prefix/include/eigen3") for p in sys.path if p]
    return next((str(place) for place in places if (place / "Eigen/Core").is_file()), None)


@click.command()
@click.option("--json", "as_json", is_flag=True, help="Machine-readable result on stdout.")
def doctor(as_json: bool) -> int:
    """Say which packages and optional tools are installed; exit code 1 if a needed one is not."""
    packages = {name: _package(name) for name, _ in _PACKAGES}
    tools = {name: shutil.which(name) for name, _ in _TOOLS}
    tools["Eigen"] = _eigen()
    words = {**dict(_TOOLS), "Eigen": "for the C++ header: libeigen3-dev or pip's cmeel-eigen"}
    missing = [name for name, found in packages.items() if found is None]
    if as_json:
        record = {"ikgen": __version__, "python": sys.version.split()[0]}
        click.echo(json.dumps({**record, "packages": packages, "tools": tools}, indent=2))
        return 1 if missing else 0
    rows = [("ikgen", __version__, ""), ("python", sys.version.split()[0], "")]
    rows += [(name, packages[name] or "MISSING: pip install " + name, w) for name, w in _PACKAGES]
    rows += [(name, found or "not found", words[name]) for name, found in tools.items()]
    click.echo(table(rows, indent=""))
    return 1 if missing else 0
