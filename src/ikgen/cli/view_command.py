"""`ikgen view`: the arm in a browser, with all solutions of a target that can be dragged."""

from __future__ import annotations

import time
import webbrowser
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ikgen.cli.console import Console
from ikgen.cli.options import chain_options
from ikgen.cli.parameter_types import GivenPath, RobotFile
from ikgen.cli.request_options import make_request
from ikgen.errors import UsageError

if TYPE_CHECKING:
    from ikgen.model.dh import DHChain
    from ikgen.reach.reach_map import ReachMap

__all__ = ["view"]


@click.command()
@click.argument("robot", type=RobotFile(), metavar="ROBOT|TABLE")
@chain_options
@click.option(
    "--port",
    metavar="N",
    type=click.IntRange(min=1, max=65535),
    default=8080,
    show_default=True,
    help="Port of this machine that the page is served on.",
)
@click.option(
    "--map",
    "map_file",
    metavar="FILE",
    type=GivenPath(),
    help="A map that ikgen reach made of the arm, .npz or .zarr, to show.",
)
@click.option("--no-browser", is_flag=True, help="Serve the page, open none.")
@click.option("-q", "--quiet", is_flag=True, help="Print errors only.")
@click.option("-v", "--verbose", is_flag=True, help="Print every step.")
def view(
    robot: Path,
    *,
    port: int,
    map_file: Path | None,
    no_browser: bool,
    quiet: bool,
    verbose: bool,
    **chain: Any,
) -> None:
    """Show all solutions of a target that is dragged in a browser, until interrupted."""
    from ikgen.derivation.derive import derive
    from ikgen.reach.stored_map import read_map
    from ikgen.report.worked_example import solver_of
    from ikgen.view.arm_scene import ArmScene, open_server, require_viser

    require_viser()  # first: a derivation may take long
    found = None if map_file is None else read_map(map_file)
    request = make_request(robot, **chain)
    with Console(quiet=quiet, verbose=verbose) as console:
        derivation = derive(request, console)
        if found is not None:
            _check_map(found, derivation.reading.dh)
        runner = solver_of(derivation)
        if runner is None:
            raise UsageError(
                "a table without numbers has no poses", hint="give [parameters] values"
            )
        server = open_server(port)
        ArmScene(server, derivation, runner, request.package_paths, found)
    address = f"http://127.0.0.1:{server.get_port()}"
    if not quiet:
        click.echo(f"showing {derivation.reading.dh.robot} at {address} until interrupted (Ctrl-C)")
    if not no_browser:
        webbrowser.open(address)
    while True:
        time.sleep(3600)


def _check_map(found: ReachMap, dh: DHChain) -> None:
    """Raises `UsageError` for a map of another arm."""
    shown, mapped = (dh.robot, dh.base_link, dh.tip_link), (found.robot, found.base, found.tip)
    if shown != mapped:
        names = [f"{robot}, {base} to {tip}" for robot, base, tip in (mapped, shown)]
        raise UsageError(
            f"the map is of {names[0]}, not of {names[1]}", hint="make one by ikgen reach"
        )
