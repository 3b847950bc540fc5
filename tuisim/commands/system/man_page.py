"""The page for `man`, made from the help of every command."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator

import click

_INDENTED = re.compile(r"^ {2,}")


def man_page(root: click.Group, version: str) -> str:
    """Return the page in the format of `man`.

    Args:
        root: The command with all others.
        version: Of the program.
    """
    context = click.Context(root, info_name=root.name)
    name = root.name or ""
    first, _, rest = _clean(root.help or "").partition("\n")
    lines = [
        f'.TH {name.upper()} 1 "" "{name} {version}" "User Commands"',
        ".SH NAME",
        f"{name} \\- {_escaped(first.rstrip('.'))}",
        ".SH SYNOPSIS",
        f".B {name}",
        "[COMMAND] [OPTIONS] ...",
        ".SH DESCRIPTION",
        *_paragraphs(rest),
        ".SH COMMANDS",
    ]
    for called in root.list_commands(context):
        if one := root.get_command(context, called):
            lines += _of_command(one, context, f"{name} {called}")
    about = "Folder of runs, drafts, preferences and config.toml, if it is set."
    lines += [".SH FILES", ".TP", ".B TUISIM_HOME", about, ""]
    return "\n".join(lines)


def _of_command(one: click.Command, parent: click.Context, name: str) -> Iterator[str]:
    context = click.Context(one, info_name=name.rpartition(" ")[2], parent=parent)
    yield f".SS {_escaped(' '.join([name, *one.collect_usage_pieces(context)]))}"
    yield from _paragraphs(_clean(one.help or ""))
    for param in one.params:
        if isinstance(param, click.Option) and (record := param.get_help_record(context)):
            yield from (".TP", f"\\fB{_escaped(record[0])}\\fR", _escaped(record[1]))
    if isinstance(one, click.Group):
        for called in one.list_commands(context):
            if below := one.get_command(context, called):
                yield from _of_command(below, context, f"{name} {called}")


def _clean(text: str) -> str:
    return inspect.cleandoc(text).replace("\b\n", "")


def _paragraphs(text: str) -> Iterator[str]:
    """Yield the lines of a help text, with a mark between paragraphs; indented lines are kept as they are."""
    for line in text.split("\n"):
        if not line.strip():
            yield ".PP"
        elif _INDENTED.match(line):
            yield from (".br", _escaped(line.strip()))
        else:
            yield _escaped(line.strip())


def _escaped(text: str) -> str:
    """Return a text in which nothing is a command of the format."""
    text = text.replace("\\", "\\\\").replace("-", "\\-")
    return "\\&" + text if text.startswith((".", "'")) else text
