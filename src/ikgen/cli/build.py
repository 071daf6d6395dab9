"""`ikgen build`."""

from __future__ import annotations

import json
import shlex
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ikgen.cli.console import Console
from ikgen.cli.error_output import as_object, say
from ikgen.cli.options import console_options, executor_option, trust_option
from ikgen.cli.parameter_types import GivenPath, RobotFile
from ikgen.cli.work_text import work_text
from ikgen.model.counted import counted
from ikgen.projects.check import mending
from ikgen.projects.config import ArmConfig, named_config
from ikgen.projects.recorded_arms import has_lost_robot, listed_arms

if TYPE_CHECKING:
    from ikgen.projects.left_outputs import LeftOutputs
    from ikgen.projects.project_build import Outcome

__all__ = ["build"]


@click.command()
@click.argument("config", type=GivenPath(), metavar="[CONFIG|DIR]", required=False)
@click.option(
    "--check", is_flag=True, help="Only say what is stale and why; exit code 1 if anything is."
)
@click.option("--force", is_flag=True, help="Generate fresh arms too.")
@click.option(
    "--robot",
    metavar="FILE",
    type=RobotFile(),
    help="The description of the outputs in DIR, where it is not any more where their record names it.",
)
@click.option(
    "--depfile",
    metavar="FILE",
    type=GivenPath(),
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
@executor_option
@trust_option
@console_options
def build(
    config: Path | None,
    *,
    check: bool,
    force: bool,
    robot: Path | None,
    depfile: Path | None,
    jobs: int | None,
    no_verify: bool,
    executor: str,
    scheduler: str | None,
    trust: bool,
    as_json: bool,
    quiet: bool,
    verbose: bool,
) -> int:
    """Generate every arm that CONFIG lists and that is not up to date.

    CONFIG is an ikgen.toml, or a pyproject.toml with [tool.ikgen]; by default the one here. Of a folder DIR
    without one those that were generated into it are made again.
    """
    path = named_config(config)
    arms = listed_arms(path, robot)
    if check:
        return _check(path, arms, robot, verify=not no_verify, as_json=as_json, quiet=quiet)
    from ikgen.processes.executors import Workers
    from ikgen.projects.left_outputs import left_outputs
    from ikgen.projects.project_build import build_arms

    arms = tuple(replace(arm, request=replace(arm.request, trust=trust)) for arm in arms)
    outcomes = []
    with Console(quiet=quiet, verbose=verbose) as console:
        made = build_arms(
            arms,
            force=force,
            verify=not no_verify,
            workers=Workers(executor, jobs, scheduler),
            progress=console,
            words=work_text if console.verbose else None,
        )
        for arm, outcome in zip(arms, made, strict=True):
            console.tell(outcome.name, outcome.steps, outcome.work)
            outcomes.append(_with_way(path, arm, outcome))
    code = max(outcome.exit_code for outcome in outcomes)
    left = left_outputs(arms)
    _print(outcomes, left, code, as_json=as_json, quiet=quiet, verbose=verbose)
    _tell_left(path, () if quiet else left)
    if depfile is not None:
        _write_depfile(depfile, arms)
    return code


def _with_way(path: Path, arm: ArmConfig, outcome: Outcome) -> Outcome:
    """The outcome, with what to type where the description is gone of outputs in a folder."""
    lost = outcome.exit_code and has_lost_robot(path, arm)
    return replace(outcome, hint=mending(path, [arm])) if lost else outcome


def _check(
    path: Path,
    arms: Sequence[ArmConfig],
    robot: Path | None,
    *,
    verify: bool,
    as_json: bool,
    quiet: bool,
) -> int:
    """Say what is stale; writes nothing and imports nothing heavy."""
    from ikgen.projects.check import reasons_checked, stale_lines

    reasons = reasons_checked(arms, verify=verify)
    code = 1 if any(reasons) else 0
    if as_json:
        rows = [
            {
                "name": arm.name,
                "record": arm.records[0].as_posix(),
                "stale": bool(reason),
                "reason": reason,
            }
            for arm, reason in zip(arms, reasons, strict=True)
        ]
        result: dict[str, Any] = {"stale": bool(code), "arms": rows}
        _echo(
            result,
            code,
            f"{counted(sum(map(bool, reasons)), 'arm')} stale",
            mending(path, arms, robot),
        )
    elif not quiet:
        names = [arm.name for arm in arms]
        click.echo("\n".join(stale_lines(list(zip(names, reasons, strict=True)))))
    if code and not quiet:
        click.echo(f"hint: {mending(path, arms, robot)}", err=True)
    return code


def _tell_left(config: Path, left: Sequence[LeftOutputs]) -> None:
    """What lies beside the outputs and no arm makes, and how to be rid of it."""
    for one in left:
        files = [path.as_posix() for path in one.files]
        text = (
            f"no arm of {config.as_posix()} makes the outputs of '{one.name}': {', '.join(files)}"
        )
        click.echo(f"warning: {text}", err=True)
        click.echo(f"hint: unless something else makes them: rm {shlex.join(files)}", err=True)


def _print(
    outcomes: Sequence[Outcome],
    left: Sequence[LeftOutputs],
    code: int,
    *,
    as_json: bool,
    quiet: bool,
    verbose: bool,
) -> None:
    if as_json:
        bad = [o for o in outcomes if o.exit_code]
        message = "; ".join(o.error for o in bad)
        hint = "\n".join(dict.fromkeys(o.hint for o in bad if o.hint))
        rest = [{"name": o.name, "files": [path.as_posix() for path in o.files]} for o in left]
        _echo({"arms": [_row(o) for o in outcomes], "left": rest}, code, message, hint)
    for o in outcomes:
        for text in o.told if not quiet else ():
            click.echo(f"{o.name}: {text}", err=True)
        for text in o.warnings if not quiet else ():
            click.echo(f"warning: {o.name}: {text}", err=True)
        if o.exit_code:
            if o.trace and verbose:
                click.echo(o.trace, err=True)
            say(o.error, o.hint)
        elif not quiet and not as_json:
            many = f", at most {counted(o.solutions, 'solution')} a pose"
            missed = f"; {o.missed}" if o.missed else ""
            made = f"generated in {o.seconds:.1f} s{many} ({o.reason}){missed}"
            state = made if o.reason else "up to date"
            click.echo(f"{o.name}: {state}")


def _row(outcome: Outcome) -> dict[str, Any]:
    return {
        "name": outcome.name,
        "generated": bool(outcome.reason) and not outcome.exit_code,
        "reason": outcome.reason,
        "files": [path.as_posix() for path in outcome.files],
        "error": outcome.message or None,
        "seconds": round(outcome.seconds, 3),
    }


def _echo(result: dict[str, Any], code: int, message: str, hint: str) -> None:
    """The result on stdout, with an error object where the command ends with one."""
    if code:
        result = {**result, "error": as_object(message, hint, code)}
    click.echo(json.dumps(result, indent=2))


def _write_depfile(path: Path, arms: Sequence[ArmConfig]) -> None:
    """What the recorded arms were read from; nothing where one could not be generated."""
    from ikgen.projects.depfile import write_depfile
    from ikgen.projects.recorded_inputs import Packages
    from ikgen.records.record import read_record

    packages = Packages()
    paths = [path for arm in arms for path in arm.records if path.is_file()]
    records = [read_record(path) for path in paths]
    targets = [record.folder / name for record in records for name in record.files]
    inputs = [file.path for record in records for file in packages.inputs(record)]
    write_depfile(path, targets, inputs)
