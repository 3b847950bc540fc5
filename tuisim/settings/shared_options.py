"""The options of `OPTIONS` as options of commands and of magic lines."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import cache
from typing import Any

import click

from tuisim.engine.core.values import Value
from tuisim.settings.command_line import Command, GroupedOption, WordType, parse
from tuisim.settings.options import APP, OPTIONS, PANEL, Option
from tuisim.settings.options import parse as parse_value

Names = Callable[[str], Iterable[str]]


def build_type(
    value: Value, flag: str, names: Callable[[], Iterable[str]] | None = None
) -> WordType:
    """Return the Click type of an option with a value as it is described in `engine.core.values`.

    Args:
        value: The description of the value.
        flag: The option's name, for errors.
        names: As for `WordType`.
    """
    return WordType(lambda text: parse_value(value, text, flag), names)


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
    kind = build_type(
        shared.value, shared.flags[0], lambda: shared.value.choices or names(shared.path)
    )
    return GroupedOption(
        [*flags, name], type=kind, metavar=shared.metavar, multiple=shared.repeats, **how
    )


def build_shared_options(
    *,
    magic: bool = False,
    without_app: bool = False,
    left_out: Sequence[str] = (),
    names: Names = lambda _: (),
) -> list[click.Parameter]:
    """Return the shared options as Click options.

    Args:
        magic: Whether they are for a magic line, not for the command line.
        without_app: Whether the options of the app are accepted but not listed in the help.
        left_out: The paths of settings whose options are not among them.
        names: Returns the names that completion offers for an option, given the path of its setting.
    """
    hidden = (APP, PANEL) if without_app else ()
    return [
        _build_parameter(option, magic=magic, hidden=option.group in hidden, names=names)
        for option in OPTIONS
        if option.path not in left_out
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
