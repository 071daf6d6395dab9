"""The `ikgen` command: its subcommands, loaded only when called, and how errors end it."""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Sequence
from importlib import import_module
from typing import NoReturn

import click

from ikgen import __version__
from ikgen.errors import IkgenError

__all__ = ["COMMANDS", "ikgen", "main", "run"]

INTERNAL_ERROR = 70
"""Exit code of a failure that is ikgen's own (EX_SOFTWARE of sysexits.h)."""

COMMANDS: dict[str, tuple[str, str]] = {
    "from-urdf": ("ikgen.cli.generate:from_urdf", "Generate from a URDF or xacro file."),
    "from-dh": ("ikgen.cli.generate:from_dh", "Generate from a DH table (TOML)."),
    "inspect": ("ikgen.cli.inspect:inspect", "Show joint tree, chains, DH table and advice."),
    "verify": ("ikgen.cli.verify:verify", "Check emitted modules against their robot."),
    "build": ("ikgen.cli.build:build", "Generate every arm that a config lists."),
    "report": ("ikgen.cli.report:report", "Write the derivation as LaTeX and HTML."),
    "cmake-dir": ("ikgen.cli.cmake_dir:cmake_dir", "Print where the CMake package files lie."),
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
    code = run(sys.argv[1:])
    try:
        sys.stdout.flush()
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    sys.exit(code)


def run(arguments: Sequence[str]) -> int:
    """Run the command line; the exit code. No exception leaves it."""
    verbose = "--verbose" in arguments or any(
        a.startswith("-") and not a.startswith("--") and "v" in a for a in arguments
    )
    try:
        code = ikgen.main(args=list(arguments), prog_name="ikgen", standalone_mode=False)
    except IkgenError as error:
        _say(error.message, error.hint)
        return error.exit_code
    except click.exceptions.NoArgsIsHelpError as error:
        click.echo(error.format_message(), err=True)
        return 2
    except click.ClickException as error:
        context = error.ctx if isinstance(error, click.UsageError) else None
        command = context.command_path if context is not None else "ikgen"
        _say(error.format_message(), f"see {command} --help")
        return 2
    except (click.Abort, KeyboardInterrupt):
        _say("interrupted", "")
        return 130
    except BrokenPipeError:
        return 0
    except OSError as error:
        where = f"{error.filename}: " if error.filename else ""
        _say(f"{where}{error.strerror or error}", "check the path and its permissions")
        return 2
    except Exception as error:
        return _internal(error, verbose)
    return code if isinstance(code, int) else 0


def _say(message: str, hint: str) -> None:
    """An error on stderr: what, and what to do."""
    click.echo(f"error: {message}", err=True)
    if hint:
        click.echo(f"hint: {hint}", err=True)


def _internal(error: Exception, verbose: bool) -> int:
    """A failure that is ikgen's own."""
    if verbose:
        import traceback

        click.echo("".join(traceback.format_exception(error)), err=True)
    text = " ".join(str(error).split()) or "no message"
    _say(
        f"internal error: {type(error).__name__}: {text}",
        "please report it with the robot description and the command line"
        + ("" if verbose else "; -v shows the traceback"),
    )
    return INTERNAL_ERROR
