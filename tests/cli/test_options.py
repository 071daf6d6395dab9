"""What the texts of options that commands share are read as."""

from __future__ import annotations

import click
import pytest
from click.testing import CliRunner

from ikgen.cli.from_robot import from_urdf
from ikgen.cli.init import init
from ikgen.cli.options import sampling_options


@click.command()
@sampling_options
def shown(samples: int, seed: int) -> None:
    """Print them."""
    click.echo(f"{samples} {seed}")


@pytest.mark.parametrize(
    ("text", "number"), [("20", 20), ("1e9", 10**9), ("2.5E3", 2500), ("12e+1", 120)]
)
def test_counts_may_have_an_exponent(text: str, number: int) -> None:
    done = CliRunner().invoke(shown, ["--samples", text])
    assert done.output == f"{number} 0\n"


@pytest.mark.parametrize("text", ["0", "0e3", "-1e3", "1.5e0", "1e-3", "1e999", "e", "1.0", "many"])
def test_what_is_no_count_is_refused(text: str) -> None:
    done = CliRunner().invoke(shown, ["--samples", text])
    assert done.exit_code == 2 and "--samples" in done.output


def test_outputs_of_a_config_are_not_said_to_be_made_again() -> None:
    """What a config lists is made by another command: nothing was made before."""
    listed, made = (
        " ".join(CliRunner().invoke(one, ["--help"]).output.split()) for one in (init, from_urdf)
    )
    assert "made again" in made and "made again" not in listed
    assert "What the config lists as outputs of each arm, for ikgen build to generate" in listed
