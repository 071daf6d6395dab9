"""`ikgen cmake-dir`."""

from __future__ import annotations

import click

__all__ = ["cmake_dir"]


@click.command("cmake-dir")
@click.option(
    "--ament",
    is_flag=True,
    help="The ament package ikgen_ament instead, to copy into a ROS 2 workspace.",
)
def cmake_dir(*, ament: bool) -> None:
    """Print the directory of ikgenConfig.cmake, for -Dikgen_DIR=$(ikgen cmake-dir)."""
    from ikgen.projects.cmake import ament_directory, cmake_directory

    click.echo((ament_directory() if ament else cmake_directory()).as_posix())
