"""`tuisim completion`: prints the script with which a shell completes commands, options and names."""

from __future__ import annotations

import click
from click.shell_completion import get_completion_class

from tuisim.commands.echo import echo_lines
from tuisim.config.command_line import command

COMPLETE_VARIABLE = "_TUISIM_COMPLETE"
"""The environment variable with which the script asks for words."""


@command(
    click.Argument(["shell"], type=click.Choice(["bash", "zsh", "fish"]), metavar="bash|zsh|fish"),
    help="""Print a script that completes commands, options and names in your shell.

    \b
    bash  in ~/.bashrc:  eval "$(tuisim completion bash)"
    zsh   in ~/.zshrc:   eval "$(tuisim completion zsh)"
    fish  tuisim completion fish > ~/.config/fish/completions/tuisim.fish
    """,
)
def completion(shell: str) -> int:
    """Print the script."""
    root = click.get_current_context().find_root().command
    scripts = get_completion_class(shell)
    assert scripts is not None
    echo_lines(scripts(root, {}, "tuisim", COMPLETE_VARIABLE).source())
    return 0
