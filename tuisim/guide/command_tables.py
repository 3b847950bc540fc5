"""Reference tables of the commands and their options."""

from __future__ import annotations

from collections.abc import Iterator
from importlib import import_module

import click

from tuisim.guide.tables import Table, code
from tuisim.settings.command_line import Group, GroupedOption


def _iterate_commands() -> Iterator[tuple[str, click.Command, str]]:
    """Yield every command and subcommand: the words to type, the command, and a sentence on its purpose."""
    # The module is imported by name, since an import statement would be circular: the command line imports the guide.
    entries = import_module("tuisim.cli").COMMANDS
    for name, entry in entries.items():
        command = entry.load()
        yield f"tuisim {name}", command, entry.does
        if isinstance(command, Group):
            for word, does in command.listing.items():
                yield f"tuisim {name} {word}", command.load(word), does


def _format_usage(words: str, command: click.Command) -> str:
    with click.Context(command, info_name=words) as context:
        pieces = command.collect_usage_pieces(context)
    return " ".join([words, *(piece for piece in pieces if piece)])


def list_commands() -> Table:
    """Return the table of the commands, each with a sentence on its purpose."""
    return Table(
        ("command", "does"),
        [
            (code(_format_usage(words, command)), does)
            for words, command, does in _iterate_commands()
        ],
    )


def list_command_options() -> Table:
    """Return the table of each command's options, without those that set up the world."""
    rows = []
    for words, command, _ in _iterate_commands():
        for param in command.params:
            if isinstance(param, click.Option) and not (
                isinstance(param, GroupedOption) and param.sets
            ):
                rows.append(
                    (code(words), code(_format_flags(param)), (param.help or "").rstrip("."))
                )
    return Table(("command", "option", "does"), rows)


def _format_flags(param: click.Option) -> str:
    names = " ".join(param.opts)
    return f"{names} {param.metavar}" if param.metavar else names
