"""`ikgen cmake-dir`."""

from __future__ import annotations

import click

__all__ = ["cmake_dir"]


@click.command("cmake-dir")
def cmake_dir() -> None:
    """Print the directory of ikgenConfig.cmake, for -Dikgen_DIR=$(ikgen cmake-dir)."""
    from ikgen.build.cmake import cmake_directory

    click.echo(cmake_directory().as_posix())
