"""`ikgen report`."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import click

from ikgen.cli.console import Console
from ikgen.cli.options import chain_options, console_options, make_request, sampling_options
from ikgen.errors import UnsolvedChainError
from ikgen.generate import Outputs, publish, verify_texts, with_samples
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
@sampling_options
@click.option("--no-verify", is_flag=True, help="Leave the table of verification out.")
@console_options
def report(
    robot: Path,
    *,
    out: Path,
    samples: int,
    seed: int,
    no_verify: bool,
    as_json: bool,
    quiet: bool,
    verbose: bool,
    **chain: Any,
) -> None:
    """Write how the inverse kinematics of ROBOT was derived: LaTeX, HTML, graph and trace.

    Without a closed form the report says how far the solver came, and the exit code is 3.
    """
    outputs = Outputs(out=out, samples=samples, seed=seed, verify=not no_verify)
    with Console(quiet=quiet, verbose=verbose) as console:
        stuck: UnsolvedChainError | None = None
        try:
            texts = _texts(derive(make_request(robot, **chain), console), outputs, console)
        except UnsolvedChainError as error:
            from ikgen.cli.remedies import helped
            from ikgen.emit.report import emit_unsolved

            stuck = helped(error, console)
            texts = emit_unsolved(stuck.unsolved, stuck.hint)
        files = [*publish(out, texts), *_pdfs(out, texts, console)]
    _say(files, as_json=as_json, quiet=quiet)
    if stuck is not None:
        raise stuck


def _say(files: list[Path], *, as_json: bool, quiet: bool) -> None:
    """What was written."""
    if as_json:
        click.echo(json.dumps({"files": [str(path) for path in files]}, indent=2))
    elif not quiet:
        for path in files:
            click.echo(f"wrote: {path}")


def _texts(derivation: Derivation, outputs: Outputs, console: Console) -> dict[str, str]:
    """File name -> text of the report, with the verification of the Python module."""
    from ikgen.emit.registry import find_emitter

    reports = {}
    if outputs.verify:
        sampled = with_samples(derivation)
        made = find_emitter("python").emit(sampled)
        reports = verify_texts(sampled, made, outputs, console)
    console("emit", "report")
    return find_emitter("report").emit(derivation, reports)


def _pdfs(out: Path, texts: Mapping[str, str], console: Console) -> list[Path]:
    """The PDFs of the LaTeX texts, where LaTeX is installed."""
    from ikgen.build.pdf import compile_latex

    made = []
    for name in texts:
        if name.endswith(".tex"):
            console("typeset", name)
            made.append(compile_latex(out / name))
    return [path for path in made if path is not None]
