"""Options that the commands share."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Sequence
from typing import Any, TypeVar

import click

from ikgen.cli.parameter_types import Emits, GivenPath, Joints, Links, Tasks
from ikgen.generation.emitters import EMITTERS
from ikgen.tasks import AXES, TASKS

__all__ = [
    "chain_options",
    "console_options",
    "emit_option",
    "executor_option",
    "executor_options",
    "force_option",
    "link_options",
    "listed_emit_option",
    "package_options",
    "reading_options",
    "sampling_options",
    "table_options",
    "trust_option",
]

F = TypeVar("F", bound=Callable[..., Any])
_FOLDER = GivenPath()


_XACRO_OPTIONS = (
    click.option("--arg", "args", multiple=True, metavar="NAME:=VALUE", help="A xacro argument."),
    click.option(
        "--package-path",
        "package_paths",
        multiple=True,
        metavar="DIR",
        type=_FOLDER,
        help="Where $(find pkg) and package:// look.",
    ),
)

_LINK_OPTIONS = (
    click.option("--base", metavar="LINK", type=Links(), help="Link that poses are given in."),
    click.option("--tip", metavar="LINK", type=Links(), help="Link to be placed."),
)

_SOLVING_OPTIONS = (
    click.option(
        "--task",
        metavar="TASK",
        type=Tasks(),
        help=f"{', '.join(task.name for task in TASKS)} (default: the most that all the arm's joints can "
        "do).",
    ),
    click.option(
        "--tool-axis",
        type=click.Choice(AXES),
        help="The tool's axis whose direction, elevation or heading counts (default: the one that suits).",
    ),
    click.option(
        "--free",
        multiple=True,
        type=Joints(),
        metavar="JOINT[=VALUE]",
        help="Hold a joint: its value becomes an input, by default VALUE (rad, m, 45deg, 120mm). "
        "JOINT may be arm-angle.",
    ),
    click.option(
        "--lock",
        multiple=True,
        type=Joints("="),
        metavar="JOINT=VALUE",
        help="Fix a joint for good (rad, m, 45deg, 120mm).",
    ),
    click.option(
        "--couple",
        multiple=True,
        metavar="JOINT=SOURCE*k+c",
        help="Make a joint follow another: its value is k times the other's plus c (rad, m). Of several "
        "sources, JOINT=A*k1+B*k2+c: what motors move it by, whose values the solver then has.",
    ),
    click.option(
        "--calibration",
        metavar="FILE",
        type=GivenPath(),
        help="The one arm's own kinematics: a calibration.yaml, or offsets of its DH rows (.toml).",
    ),
    click.option(
        "--name",
        metavar="NAME",
        help="Prefix of the output files (default: the robot's name).",
    ),
)

_PACKAGE_OPTIONS = (
    click.option(
        "--maintainer", metavar="'NAME <EMAIL>'", help="Who maintains an emitted ROS package."
    ),
    click.option(
        "--license", metavar="NAME", help="Licence of an emitted ROS package, as SPDX names it."
    ),
)

trust_option = click.option(
    "--trust",
    is_flag=True,
    help="Let xacro files run any code and read any file: for files of your own.",
)


_OUTPUTS = f"{', '.join(row.name for row in EMITTERS)}, and those of other packages (ikgen doctor)"


def _emit_option(words: str) -> Callable[[F], F]:
    return click.option("--emit", multiple=True, metavar="NAME,...", type=Emits(), help=words)


emit_option = _emit_option(
    f"Outputs (default: python): {_OUTPUTS}. Those that were made here before are made again."
)

listed_emit_option = _emit_option(
    "What the config lists as outputs of each arm, for ikgen build to generate: one or more of "
    f"{_OUTPUTS}, separated by commas. Default: python."
)


force_option = click.option(
    "--force", is_flag=True, help="Replace files that ikgen did not write, or that were edited."
)


def _apply(options: Sequence[Callable[[Any], Any]], function: F) -> F:
    """The decorators on a function, listed in help in the order given."""
    for option in reversed(options):
        function = option(function)
    return function


def chain_options(function: F) -> F:
    """Which chain of the robot, which task, and how to read the file."""
    return _apply([*_LINK_OPTIONS, *_SOLVING_OPTIONS, *_XACRO_OPTIONS, trust_option], function)


def link_options(function: F) -> F:
    """Which chain of the robot."""
    return _apply(_LINK_OPTIONS, function)


def table_options(function: F) -> F:
    """Which task, and how to read a DH table, which has one chain."""
    return _apply(_SOLVING_OPTIONS, function)


def package_options(function: F) -> F:
    """What a ROS package says of itself."""
    return _apply(_PACKAGE_OPTIONS, function)


def reading_options(function: F) -> F:
    """How to read the file."""
    return _apply([*_XACRO_OPTIONS, trust_option], function)


class _Count(click.IntRange):
    """A whole number from 1 on, with an exponent too: `1e9`."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """The number as an int."""
        if isinstance(value, str) and "e" in value.lower():
            with contextlib.suppress(ValueError):
                number = float(value)
                value = int(number) if number.is_integer() else value
        return super().convert(value, param, ctx)


def sampling_options(function: F) -> F:
    """How much is verified."""
    return _apply(
        [
            click.option(
                "--samples",
                metavar="N",
                type=_Count(min=1),
                default=1000,
                show_default=True,
                help="Random poses in the verification.",
            ),
            click.option(
                "--seed",
                metavar="N",
                type=click.IntRange(min=0),
                default=0,
                show_default=True,
                help="Seed of the random poses.",
            ),
        ],
        function,
    )


def console_options(function: F) -> F:
    """What is printed."""
    return _apply(
        [
            click.option(
                "--json", "as_json", is_flag=True, help="Machine-readable result on stdout."
            ),
            click.option("-q", "--quiet", is_flag=True, help="Print errors only."),
            click.option("-v", "--verbose", is_flag=True, help="Print every step and check."),
        ],
        function,
    )


_EXECUTOR_OPTIONS = (
    click.option(
        "--executor",
        type=click.Choice(["process", "dask"]),
        default="process",
        show_default=True,
        help="Processes of this machine, or Dask (a local cluster without --scheduler).",
    ),
    click.option("--scheduler", metavar="ADDRESS", help="The Dask scheduler that runs already."),
)

_WORKERS_OPTION = click.option(
    "--workers", metavar="N", type=click.IntRange(min=1), help="How many (default: one a core)."
)


def executor_options(function: F) -> F:
    """Who computes, and how many of them."""
    return _apply([*_EXECUTOR_OPTIONS, _WORKERS_OPTION], function)


def executor_option(function: F) -> F:
    """Who computes."""
    return _apply(_EXECUTOR_OPTIONS, function)
