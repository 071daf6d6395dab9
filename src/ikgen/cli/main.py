"""The `ikgen` command: its subcommands, loaded only when called, and how errors end it."""

from __future__ import annotations

import contextlib
import gc
import os
import re
import sys
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import NoReturn

import click

from ikgen import __version__
from ikgen.cli.error_output import ResultError, as_object, say, say_object, say_work
from ikgen.errors import told
from ikgen.processes.termination import TERMINATED, Terminated, unwind_on_signals

__all__ = ["COMMANDS", "ikgen", "main", "run"]

_XACRO_ARGUMENT = re.compile(r"unexpected extra argument \(([\w.-]+:=\S*)\)")
"""What is written as xacro's own command line has it."""

COMMANDS: dict[str, tuple[str, str]] = {
    "from-urdf": ("ikgen.cli.from_robot:from_urdf", "Generate from a URDF or xacro file."),
    "from-dh": ("ikgen.cli.from_robot:from_dh", "Generate from a DH table (TOML)."),
    "inspect": ("ikgen.cli.inspect:inspect", "Show joint tree, chains, DH table and advice."),
    "verify": ("ikgen.cli.verify:verify", "Check emitted modules against their robot."),
    "init": ("ikgen.cli.init:init", "Write a config with every arm of a robot."),
    "build": ("ikgen.cli.build:build", "Generate every arm that a config lists."),
    "report": ("ikgen.cli.report:report", "Write the derivation as LaTeX and HTML."),
    "robots": ("ikgen.cli.robots:robots", "List robots that are known by name, with their arms."),
    "view": ("ikgen.cli.view_command:view", "Drag a target, see all solutions, in a browser."),
    "reach": ("ikgen.cli.reach_command:reach", "Map which poses an arm reaches."),
    "cmake-dir": ("ikgen.cli.cmake_dir:cmake_dir", "Print where the CMake package files lie."),
    "completion": ("ikgen.cli.completion:completion", "Print completion for a shell."),
    "doctor": ("ikgen.cli.doctor:doctor", "Say which tools and plug-ins there are."),
}
"""Command -> (where its function is, one line of help)."""


class LazyGroup(click.Group):
    """A group that imports a subcommand's module only when the subcommand is called."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """All commands in the order of use."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, name: str) -> click.Command | None:
        """The command of a name, imported now."""
        if name not in COMMANDS:
            return None
        module, function = COMMANDS[name][0].split(":")
        command: click.Command = getattr(import_module(module), function)
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """The table of commands, from the registry alone."""
        with formatter.section("Commands"):
            formatter.write_dl([(name, words) for name, (_, words) in COMMANDS.items()])


@click.group(cls=LazyGroup, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, "--version", message="ikgen %(version)s")
def ikgen() -> None:
    """Verified, closed-form inverse kinematics code from a robot description."""


def main() -> NoReturn:
    """Run the command line and exit."""
    warnings.simplefilter("ignore")  # NumPy's, of divisions whose results are then discarded
    gc.set_threshold(50_000, 50, 50)  # most of what a run makes it needs to its end
    unwind_on_signals()
    _open_closed_streams()
    code = run(sys.argv[1:])
    try:
        sys.stdout.flush()
    except OSError as error:  # what is still buffered must not be tried again when Python ends
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        if not isinstance(error, BrokenPipeError):
            code = code or 2
            say(f"cannot write to stdout: {error.strerror}")
    sys.exit(code)


def _open_closed_streams() -> None:
    """Whoever starts a program with stdout or stderr closed wants to hear nothing."""
    if sys.stdout is None:
        sys.stdout = Path(os.devnull).open("w", encoding="utf-8")  # noqa: SIM115
    if sys.stderr is None:
        sys.stderr = Path(os.devnull).open("w", encoding="utf-8")  # noqa: SIM115


def run(arguments: Sequence[str]) -> int:
    """Run the command line; the exit code. No exception leaves it."""
    try:
        code = ikgen.main(args=list(arguments), prog_name="ikgen", standalone_mode=False)
    except BrokenPipeError:
        return 0
    except (Exception, KeyboardInterrupt, Terminated) as error:
        return _failed(error, _Wanted.of(arguments))
    except SystemExit as end:
        if end.code == 1:  # click's, where a reader has closed the pipe
            return 0
        raise  # a completion has ended
    return code if isinstance(code, int) else 0


@dataclass(frozen=True, slots=True)
class _Wanted:
    """How errors are to be told; read from the words, since they may not even parse."""

    as_json: bool
    verbose: bool

    @classmethod
    def of(cls, arguments: Sequence[str]) -> _Wanted:
        short = [a for a in arguments if a.startswith("-") and not a.startswith("--")]
        verbose = "--verbose" in arguments or any("v" in a for a in short)
        return cls("--json" in arguments, verbose)


def _failed(error: BaseException, wanted: _Wanted) -> int:
    """Say what ended the command: on stderr, and as an object where JSON is wanted; the exit code."""
    result = error.result if isinstance(error, ResultError) else None
    error = error.error if isinstance(error, ResultError) else error
    if isinstance(error, click.exceptions.NoArgsIsHelpError):
        message, hint, code = error.format_message(), "", 2
        click.echo(message, err=True)
    else:
        message, hint, code = _explained(error, wanted.verbose)
        if wanted.verbose:
            say_work(error, code)
        say(message, hint)
    if wanted.as_json:
        with contextlib.suppress(OSError):  # stdout may be what the error is about
            say_object(as_object(message, hint, code, error), result)
    return code


def _explained(error: BaseException, verbose: bool) -> tuple[str, str, int]:
    """Message, hint and exit code, also of what the command line itself ends with."""
    if isinstance(error, click.ClickException):
        context = error.ctx if isinstance(error, click.UsageError) else None
        command = context.command_path if context is not None else "ikgen"
        message = error.format_message()
        xacro = _XACRO_ARGUMENT.search(message)
        hint = f"an argument of xacro: --arg {xacro[1]}" if xacro else f"see {command} --help"
        return message, hint, 2
    if isinstance(error, click.Abort | KeyboardInterrupt):
        return "interrupted", "", 130
    if isinstance(error, Terminated):
        return "ended by a signal", "", TERMINATED
    return told(error, traced=verbose)
