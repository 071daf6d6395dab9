"""`ikgen report`."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ikgen.cli.console import Console
from ikgen.cli.options import chain_options, console_options, make_request, sampling_options
from ikgen.errors import IkgenError, UnsolvedChainError, VerificationError
from ikgen.generation.generation import Outputs, verify_texts, with_samples
from ikgen.generation.pipeline import Derivation, Request, derive
from ikgen.generation.publish import Content, publish

if TYPE_CHECKING:
    from ikgen.verify.verification_report import VerificationReport

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

    Without a closed form the report says how far the solver came, and the exit code is 3; with a
    failed verification it has the failed checks, and the exit code is 1.
    """
    outputs = Outputs(out=out, samples=samples, seed=seed, verify=not no_verify)
    with Console(quiet=quiet, verbose=verbose) as console:
        texts, wrong = _written(make_request(robot, **chain), outputs, console)
        made: dict[str, Content] = {**texts, **_pdfs(texts, console)}
        stale = _stale_pdfs(out, made)
        files = publish(out, made)
        for pdf in stale:
            pdf.unlink()
            console.warn(f"removed {pdf}: it was made from an earlier report")
    _say(files, as_json=as_json, quiet=quiet)
    if wrong is not None:
        raise wrong


def _written(
    request: Request, outputs: Outputs, console: Console
) -> tuple[dict[str, str], IkgenError | None]:
    """File name -> text of the report, and the error to end with: of an arm without a closed form, or
    of a verification that failed. Either is in the report."""
    from ikgen.report import emit_report, emit_unsolved

    try:
        derivation = derive(request, console)
    except UnsolvedChainError as error:
        from ikgen.generation.remedies import helped

        stuck = helped(error, console)
        return emit_unsolved(stuck.unsolved, stuck.hint), stuck
    wrong = None
    try:
        reports = _reports(derivation, outputs, console)
    except VerificationError as error:
        reports = error.reports
        wrong = VerificationError(error.message, reports=reports, hint="the report has all checks")
    console("emit", "report")
    return emit_report(derivation, reports), wrong


def _say(files: Sequence[Path], *, as_json: bool, quiet: bool) -> None:
    """What was written."""
    if as_json:
        click.echo(json.dumps({"files": [str(path) for path in files]}, indent=2))
    elif not quiet:
        for path in files:
            click.echo(f"wrote: {path}")


def _reports(
    derivation: Derivation, outputs: Outputs, console: Console
) -> Mapping[str, VerificationReport]:
    """The verification of the Python module."""
    from ikgen.generation.emitters import find_emitter

    if not outputs.verify:
        return {}
    sampled = with_samples(derivation)
    made = find_emitter("python").emit(sampled)
    return verify_texts(sampled, made, outputs, console)


def _pdfs(texts: Mapping[str, str], console: Console) -> dict[str, bytes]:
    """File name -> PDF of the LaTeX texts, where LaTeX is installed; warns where it fails."""
    from ikgen.report.pdf import typeset

    made = {}
    for name, text in texts.items():
        if name.endswith(".tex"):
            console("typeset", name)
            result = typeset(name, text)
            if result.pdf is not None:
                made[str(Path(name).with_suffix(".pdf"))] = result.pdf
            elif result.failure:
                console.warn(f"no PDF of {name}: {result.failure}")
    return made


def _stale_pdfs(out: Path, made: Mapping[str, Content]) -> list[Path]:
    """PDFs that are there, are not made anew, and whose LaTeX text is about to change."""
    found = []
    for name, content in made.items():
        tex, pdf = out / name, (out / name).with_suffix(".pdf")
        lacks = name.endswith(".tex") and str(Path(name).with_suffix(".pdf")) not in made
        if lacks and pdf.is_file():
            earlier = tex.read_text(encoding="utf-8") if tex.is_file() else None
            found += [pdf] if earlier != content else []
    return found
