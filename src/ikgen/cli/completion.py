"""`ikgen completion`: completion of commands, options and names in a shell."""

from __future__ import annotations

import click
from click.shell_completion import get_completion_class

__all__ = ["completion"]

_SHELLS = ("bash", "zsh", "fish")
_VARIABLE = "_IKGEN_COMPLETE"


@click.command()
@click.argument("shell", type=click.Choice(_SHELLS))
def completion(shell: str) -> None:
    """Print what makes a shell complete commands, options, tasks, outputs, links and joints.

    For bash: eval "$(ikgen completion bash)" in ~/.bashrc; for zsh the same in ~/.zshrc; for fish:
    ikgen completion fish > ~/.config/fish/completions/ikgen.fish
    """
    kind = get_completion_class(shell)
    assert kind is not None
    click.echo(kind(click.Command("ikgen"), {}, "ikgen", _VARIABLE).source())
