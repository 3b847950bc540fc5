"""The options of `OPTIONS` as options of commands and of magic lines."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import cache
from typing import Any

import click

from tuisim.settings.command_line import Command, GroupedOption, WordType, parse
from tuisim.settings.options import OPTIONS, Option
from tuisim.settings.options import parse as parse_value

Names = Callable[[str], Iterable[str]]


def _build_parameter(shared: Option, *, magic: bool, hidden: bool, names: Names) -> GroupedOption:
    flags = [*shared.flags, *(shared.magic_flags if magic else ())]
    how: dict[str, Any] = {
        "group": shared.group,
        "sets": shared.path,
        "help": shared.help,
        "hidden": hidden,
    }
    name = shared.path.replace(".", "_")
    if shared.panel:
        return GroupedOption(
            [*flags, f"panel_{shared.panel}"], is_flag=True, adds=shared.panel, **how
        )
    if shared.constant is not None:
        return GroupedOption([*flags, name], flag_value=shared.constant, default=None, **how)
    kind = WordType(
        lambda text: parse_value(shared.value, text, shared.flags[0]),
        lambda: shared.value.choices or names(shared.path),
    )
    return GroupedOption(
        [*flags, name], type=kind, metavar=shared.metavar, multiple=shared.repeats, **how
    )


def build_shared_options(
    *, magic: bool = False, hidden: Iterable[str] = (), names: Names = lambda _: ()
) -> list[click.Parameter]:
    """Return the shared options as Click options.

    Args:
        magic: Whether they are for a magic line, not for the command line.
        hidden: Groups of options that are accepted but not listed in the help.
        names: Returns the names that completion offers for an option, given the path of its setting.
    """
    return [
        _build_parameter(option, magic=magic, hidden=option.group in hidden, names=names)
        for option in OPTIONS
    ]


def parse_words(words: Sequence[str]) -> dict[str, Any]:
    """Return the options in a program's magic line as settings, by path.

    Raises:
        ConfigError: a word is no option, or a value is wrong.
    """
    return dict(parse(_build_magic_line(), words).settings)


@cache
def _build_magic_line() -> Command:
    return Command("tuisim", params=build_shared_options(magic=True), add_help_option=False)
