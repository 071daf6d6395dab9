"""`ikgen report`."""

from __future__ import annotations

import json
from collections.abc import Mapping
from importlib import import_module
from pathlib import Path
from typing import Any

import click

from ikgen.cli.console import Console
from ikgen.cli.options import chain_options, console_options, make_request
from ikgen.errors import IkgenError
from ikgen.generate import publish
from ikgen.pipeline import Derivation, derive

__all__ = ["report"]


@click.command()
@click.argument("robot", type=click.Path(path_type=Path), metavar="ROBOT|TABLE")
@chain_options
@click.option(
    "-o",
    "--output",
    "out",
    metavar="DIR",
    type=click.Path(path_type=Path),
    default=Path(),
    help="Where the report goes (default: here).",
)
@console_options
def report(
    robot: Path, *, out: Path, as_json: bool, quiet: bool, verbose: bool, **chain: Any
) -> None:
    """Write how the inverse kinematics of ROBOT was derived: LaTeX, HTML, graph and trace."""
    with Console(quiet=quiet, verbose=verbose) as console:
        derivation = derive(make_request(robot, **chain), console)
        console("emit", "report")
        texts = _texts(derivation)
        files = [*publish(out, texts), *_pdfs(out, texts, console)]
    if as_json:
        click.echo(json.dumps({"files": [str(path) for path in files]}, indent=2))
    elif not quiet:
        for path in files:
            click.echo(f"wrote: {path}")


def _pdfs(out: Path, texts: Mapping[str, str], console: Console) -> list[Path]:
    """The PDFs of the LaTeX texts, where LaTeX is installed."""
    from ikgen.build.pdf import compile_latex

    made = []
    for name in texts:
        if name.endswith(".tex"):
            console("typeset", name)
            made.append(compile_latex(out / name))
    return [path for path in made if path is not None]


def _texts(derivation: Derivation) -> dict[str, str]:
    """File name -> text of the report."""
    try:
        module = import_module("ikgen.emit.report")
    except ModuleNotFoundError as error:
        raise IkgenError("this installation cannot write reports", hint=str(error)) from None
    texts: dict[str, str] = module.emit_report(derivation)
    return texts
