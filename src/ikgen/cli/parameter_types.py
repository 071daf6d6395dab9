"""Types of the parameters of commands: what they take, and the names that a shell completes them with."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path
from typing import Any

import click
from click.shell_completion import CompletionItem

from ikgen.errors import IkgenError
from ikgen.generation.emitters import emitter_names
from ikgen.importers.named_robots import DATA, robot_names
from ikgen.tasks import task_names

__all__ = ["Emits", "GivenPath", "Joints", "Links", "RobotFile", "Tasks"]


class _Names(click.ParamType[str]):
    """Text that is one of some names, for completion alone."""

    name = "text"

    def names(self, ctx: click.Context) -> list[str]:
        """The names, given what was typed so far."""
        raise NotImplementedError

    def shell_complete(
        self, ctx: click.Context, param: click.Parameter, incomplete: str
    ) -> list[CompletionItem]:
        """The names that begin as what is typed."""
        return [CompletionItem(n) for n in self.names(ctx) if n.startswith(incomplete)]


class Tasks(_Names):
    """A task."""

    def names(self, ctx: click.Context) -> list[str]:
        """ikgen's own and those of other packages."""
        return task_names()


class Emits(_Names):
    """Outputs, separated by commas."""

    def names(self, ctx: click.Context) -> list[str]:
        """ikgen's own and those of other packages."""
        return emitter_names()

    def shell_complete(
        self, ctx: click.Context, param: click.Parameter, incomplete: str
    ) -> list[CompletionItem]:
        """The last of several, those before it kept."""
        before, comma, last = incomplete.rpartition(",")
        return [
            CompletionItem(before + comma + item.value)
            for item in super().shell_complete(ctx, param, last)
            if item.value not in before.split(",")
        ]


class Links(_Names):
    """A link of the robot that stands before."""

    def names(self, ctx: click.Context) -> list[str]:
        """The links in the order of the file; none of a file that cannot be read."""
        tree = _tree(ctx)
        return list(tree.links) if tree is not None else []


class Joints(_Names):
    """A moving joint of the robot that stands before; `end` is what follows the name."""

    def __init__(self, end: str = "") -> None:
        self.end = end

    def names(self, ctx: click.Context) -> list[str]:
        """The joints in the order of the file; none of a file that cannot be read."""
        tree = _tree(ctx)
        joints = tree.joints if tree is not None else ()
        return [f"{joint.name}{self.end}" for joint in joints if joint.type.moves_on_one_axis]


class GivenPath(click.Path):
    """A path that must not be empty: an unset shell variable in quotes gives ""."""

    def __init__(self) -> None:
        super().__init__(path_type=Path)

    def convert(
        self,
        value: str | os.PathLike[str],
        param: click.Parameter | None,
        ctx: click.Context | None,
    ) -> Any:
        """The path."""
        if value == "":
            self.fail("the path is empty", param, ctx)
        return super().convert(value, param, ctx)


class RobotFile(GivenPath):
    """A file, or a robot by its name in a package."""

    def shell_complete(
        self, ctx: click.Context, param: click.Parameter, incomplete: str
    ) -> list[CompletionItem]:
        """Files; after the name of a package its robots."""
        if incomplete.startswith(f"{DATA}:"):
            with suppress(IkgenError):
                names = (f"{DATA}:{name}" for name in robot_names(DATA))
                return [CompletionItem(name) for name in names if name.startswith(incomplete)]
        return super().shell_complete(ctx, param, incomplete)


def _tree(ctx: click.Context) -> Any | None:
    """What the file says that was typed; what keeps it from being read is no matter of a completion."""
    from ikgen.cli.request_options import make_request
    from ikgen.derivation.read import read_tree

    # an option that still lacks its value leaves what stood before it among the rest
    robot = ctx.params.get("robot") or next(iter(ctx.args), None)
    if robot is None or str(robot).lower().endswith(".toml"):
        return None
    with suppress(IkgenError, OSError):
        args = ctx.params.get("args") or ()
        paths = ctx.params.get("package_paths") or ()
        return read_tree(make_request(Path(robot), args=args, package_paths=paths))
    return None
