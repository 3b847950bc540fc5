"""Reference tables of the commands and their options."""

from __future__ import annotations

from collections.abc import Iterator
from importlib import import_module

import click

from tuisim.guide.tables import Table, code
from tuisim.settings.command_line import Group, GroupedOption


def _commands() -> Iterator[tuple[str, click.Command, str]]:
    """Yield every command and subcommand: its words, itself, and what it does."""
    # The command line is above the guide, which it imports.
    entries = import_module("tuisim.cli").COMMANDS
    for name, entry in entries.items():
        found = entry.load()
        yield f"tuisim {name}", found, entry.does
        if isinstance(found, Group):
            for word, does in found.listing.items():
                yield f"tuisim {name} {word}", found.load(word), does


def _usage(words: str, found: click.Command) -> str:
    with click.Context(found, info_name=words) as context:
        pieces = found.collect_usage_pieces(context)
    return " ".join([words, *(piece for piece in pieces if piece)])


def commands() -> Table:
    """Return every command and what it does."""
    return Table(
        ("command", "does"),
        [(code(_usage(words, found)), does) for words, found, does in _commands()],
    )


def command_options() -> Table:
    """Return the options of each command, without those that set up the world."""
    rows = []
    for words, found, _ in _commands():
        for param in found.params:
            if isinstance(param, click.Option) and not (
                isinstance(param, GroupedOption) and param.sets
            ):
                rows.append((code(words), code(_names(param)), (param.help or "").rstrip(".")))
    return Table(("command", "option", "does"), rows)


def _names(param: click.Option) -> str:
    names = " ".join(param.opts)
    return f"{names} {param.metavar}" if param.metavar else names
