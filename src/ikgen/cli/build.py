"""`ikgen build`."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from ikgen.cli.console import Console
from ikgen.cli.options import console_options
from ikgen.projects.config import ArmConfig, load_config, named_config

if TYPE_CHECKING:
    from ikgen.projects.project_build import Outcome

__all__ = ["build"]


@click.command()
@click.argument("config", type=click.Path(path_type=Path), metavar="[CONFIG]", required=False)
@click.option(
    "--check", is_flag=True, help="Only say what is stale and why; exit code 1 if anything is."
)
@click.option("--force", is_flag=True, help="Generate fresh arms too.")
@click.option(
    "--depfile",
    metavar="FILE",
    type=click.Path(path_type=Path),
    help="Also write which files the outputs depend on, as a Makefile rule.",
)
@click.option(
    "--jobs",
    "-j",
    metavar="N",
    type=click.IntRange(min=1),
    help="Arms at a time (default: one a processor).",
)
@click.option(
    "--no-verify",
    is_flag=True,
    help="Leave the verification out (and Pinocchio with it); unverified outputs count as fresh.",
)
@console_options
def build(
    config: Path | None,
    *,
    check: bool,
    force: bool,
    depfile: Path | None,
    jobs: int | None,
    no_verify: bool,
    as_json: bool,
    quiet: bool,
    verbose: bool,
) -> int:
    """Generate every arm that CONFIG lists and that is not up to date.

    CONFIG is an ikgen.toml, or a pyproject.toml with [tool.ikgen]; by default the one here.
    """
    arms = load_config(named_config(config))
    if check:
        return _check(arms, verify=not no_verify, as_json=as_json, quiet=quiet)
    from ikgen.projects.project_build import build_arms

    with Console(quiet=quiet, verbose=verbose) as console:
        outcomes = list(
            build_arms(arms, force=force, verify=not no_verify, jobs=jobs, progress=console)
        )
    _print(outcomes, as_json=as_json, quiet=quiet, verbose=verbose)
    if depfile is not None:
        _write_depfile(depfile, arms)
    return max(outcome.exit_code for outcome in outcomes)


def _check(arms: Sequence[ArmConfig], *, verify: bool, as_json: bool, quiet: bool) -> int:
    """Say what is stale; writes nothing and imports nothing heavy."""
    from ikgen.projects.check import stale_lines
    from ikgen.projects.stale import stale_reasons

    reasons = {
        arm.record_path.as_posix(): (arm.name, reason)
        for arm, reason in zip(arms, stale_reasons(arms, verify=verify), strict=True)
    }
    stale = any(reason for _, reason in reasons.values())
    if as_json:
        rows = [
            {"name": name, "record": path, "stale": bool(reason), "reason": reason}
            for path, (name, reason) in reasons.items()
        ]
        click.echo(json.dumps({"stale": stale, "arms": rows}, indent=2))
    elif not quiet:
        click.echo("\n".join(stale_lines(list(reasons.values()))))
    return 1 if stale else 0


def _print(outcomes: Sequence[Outcome], *, as_json: bool, quiet: bool, verbose: bool) -> None:
    if as_json:
        rows = [
            {
                "name": o.name,
                "generated": bool(o.reason) and not o.exit_code,
                "reason": o.reason,
                "files": [path.as_posix() for path in o.files],
                "error": o.message or None,
                "seconds": round(o.seconds, 3),
            }
            for o in outcomes
        ]
        click.echo(json.dumps({"arms": rows}, indent=2))
    for o in outcomes:
        if o.exit_code:
            if o.trace and verbose:
                click.echo(o.trace, err=True)
            click.echo(f"error: {o.name}: {o.message}", err=True)
            if o.hint:
                click.echo(f"hint: {o.hint}", err=True)
        elif not quiet and not as_json:
            state = f"generated in {o.seconds:.1f} s ({o.reason})" if o.reason else "up to date"
            click.echo(f"{o.name}: {state}")


def _write_depfile(path: Path, arms: Sequence[ArmConfig]) -> None:
    """What the recorded arms were read from; nothing where one could not be generated."""
    from ikgen.generation.record import read_record
    from ikgen.projects.depfile import write_depfile
    from ikgen.projects.recorded_inputs import Packages

    packages = Packages()
    records = [read_record(arm.record_path) for arm in arms if arm.record_path.is_file()]
    targets = [record.folder / name for record in records for name in record.files]
    inputs = [file.path for record in records for file in packages.inputs(record)]
    write_depfile(path, targets, inputs)
