"""Commands by Click: options in groups, subcommands loaded on use, and wrong use as ConfigError.

Shell and notebook use it; the child process does not.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from glob import escape, glob
from itertools import chain, pairwise
from types import MappingProxyType, SimpleNamespace
from typing import Any, Self

import click
from click.core import ParameterSource
from click.shell_completion import CompletionItem

from tuisim.base.errors import ConfigError, closest, did_you_mean, nearest

ARGUMENTS_FOLLOW = "--"
"""Words after this one on the command line are passed to the program."""
GENERAL = "Options"
Arguments = SimpleNamespace
"""The parsed arguments of a command, by name; `settings` has the shared options by path."""

_FILES = ("FILE", "[NAME|FILE]", "FOLDER", "MAT", "ROBOT", "NAME")
"""Placeholders of values that may be files."""
_WORDS = "tuisim.words"
"""The words of a command, in the context's notes."""
_ATTACHED = re.compile(r"\A(-[A-Za-z])=")
"""A short option before its value, as in `-x=5`."""


class WordType(click.ParamType):  # type: ignore[type-arg]
    """The Click type of an option or argument: it converts the text that the user has typed, and completes it.

    Args:
        convert: Returns the value for a text; raises ConfigError if the text is not allowed.
        names: Returns the names that completion offers besides files.
    """

    name = "value"

    def __init__(
        self, convert: Callable[[str], Any] = str, names: Callable[[], Iterable[str]] | None = None
    ) -> None:
        self._convert = convert
        self._names = names

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the value for a text that the user has typed.

        A value that is not a text, such as a default, is returned unchanged.
        """
        return self._convert(value) if isinstance(value, str) else value

    def shell_complete(
        self, ctx: click.Context, param: click.Parameter, incomplete: str
    ) -> list[CompletionItem]:
        """Return the completions of a word: the names and files that begin with it."""
        names = self._names() if self._names else ()
        completions = [CompletionItem(name) for name in names if name.startswith(incomplete)]
        return (
            _add_files(completions, incomplete)
            if param.metavar in _FILES or param.nargs == -1
            else completions
        )


def _add_files(completions: list[CompletionItem], incomplete: str) -> list[CompletionItem]:
    """Return the completions of a word, and after them the paths of the files that begin with the word.

    If there are no completions, return one that makes the shell complete files itself, with quotes where needed.

    Args:
        completions: The completions that are not files.
        incomplete: The word, as far as it has been typed.
    """
    if not completions:
        return [CompletionItem(incomplete, type="file")]
    return (
        completions + [CompletionItem(path) for path in sorted(glob(escape(incomplete) + "*"))]
        if incomplete
        else completions
    )


class GroupedOption(click.Option):
    """A Click option that the help lists under the heading `group`, with at most two of its names.

    Args:
        sets: The path of the setting that the option changes; empty if it changes none.
        adds: The word that an option without a value adds to the list in that setting; empty for other options.
    """

    def __init__(
        self, flags: Sequence[str], group: str = GENERAL, sets: str = "", adds: str = "", **how: Any
    ) -> None:
        super().__init__(flags, **how)
        self.group = group
        self.sets = sets
        self.adds = adds
        self.needs_value = not self.is_flag and "flag_value" not in how

    def get_help_record(self, ctx: click.Context) -> tuple[str, str] | None:
        """Return two columns of the help: the option's names with its value, and its help; None if it is hidden."""
        names = ", ".join(self.opts[:2])
        return (
            None
            if self.hidden
            else (f"{names} {self.metavar}" if self.metavar else names, self.help or "")
        )


def option(*flags: str, **how: Any) -> GroupedOption:
    """Return an option; the arguments are those of Click's decorator `click.option`."""
    return GroupedOption(flags, **how)


def choice(flag: str, allowed: Sequence[str], **how: Any) -> GroupedOption:
    """Return an option whose value is one of several words.

    Args:
        flag: The option's name.
        allowed: The words.
        **how: Other arguments of `option`.
    """
    return GroupedOption([flag], type=click.Choice(allowed), metavar="|".join(allowed), **how)


def argument(
    name: str, metavar: str, names: Callable[[], Iterable[str]] | None = None, **how: Any
) -> click.Argument:
    """Return a positional argument of a command.

    Args:
        name: Its name in Python.
        metavar: Its name in the help.
        names: Returns the names that completion offers besides files.
        **how: Other arguments of `click.Argument`.
    """
    return click.Argument([name], metavar=metavar, type=WordType(names=names), **how)


_SYNONYMS = tuple(
    frozenset(words.split())
    for words in (
        "timeout limit time-limit max-time duration seconds deadline",
        "out export output file csv save write destination",
        "background mat map field board",
        "angle heading direction rotation orientation",
        "seeds repeat repetitions runs times trials",
        "jobs processes threads parallel cores",
        "speed rate factor fast",
        "fps frame-rate framerate frames",
        "break breakpoint stop-at",
        "profile rules physics",
        "input stdin answer answers",
        "press button buttons key",
        "search find query grep",
        "from start begin since",
        "to end until",
        "isolate sandbox",
        "solid collide collisions",
        "pixels graphics images",
        "json format",
        "time at when",
    )
)
"""Words for the same, of which options have one or two."""


def _close_names(typed: str, names: Iterable[str]) -> list[str]:
    """Return up to two names that may be meant by a typed word: synonyms of it, else similar names."""
    known = [*names]
    ends = {name[-len(typed) :] for name in known}
    close = [name for end in closest(typed, ends, 2, 0.75) for name in known if name.endswith(end)]
    like = [*close, *closest(typed, known, 2)]
    synonyms = {word for words in _SYNONYMS if typed.lower() in words for word in words}
    same = [name for name in known if name in synonyms]
    return list(dict.fromkeys(same or like))[:2]


def _convert_error(error: click.UsageError, ctx: click.Context) -> ConfigError:
    """Return an error of Click as a ConfigError, which says what is wrong and what is allowed."""
    see = f"see `{ctx.command_path} --help`" if ctx.command.add_help_option else ""
    if isinstance(error, click.NoSuchOption):
        names = {flag.lstrip("-"): flag for param in ctx.command.params for flag in param.opts}
        near = [names[name] for name in _close_names(error.option_name.lstrip("-"), names)]
        instead = ctx.command.instead if isinstance(ctx.command, Command) else {}
        hint = instead.get(error.option_name) or did_you_mean(near) or see
        return ConfigError(f"no such option: {error.option_name}", hint)
    if isinstance(error, click.MissingParameter) and isinstance(error.param, click.Argument):
        return ConfigError(f"{error.param.make_metavar(ctx)} is missing", see)
    text = error.message.rstrip(".")
    text = text.replace("not a valid float", "no number").replace("valid integer", "whole number")
    if isinstance(error, click.BadParameter) and error.param:
        return ConfigError(text, see, key=error.param.opts[0])
    return ConfigError(text[:1].lower() + text[1:], _explain_case(ctx, text) or see)


def _explain_case(ctx: click.Context, text: str) -> str:
    """Return a hint if the user seems to have typed the letter of an option in the wrong case; empty if not.

    This is so if the user typed a value after an option that takes none, such as `-x 5`, and the option with the letter
    in the other case, such as `-X`, takes one.

    Args:
        ctx: The command with its words.
        text: The error, which contains the value in parentheses.
    """
    options = {flag: param for param in ctx.command.params for flag in param.opts}
    for flag, value in pairwise(ctx.meta[_WORDS]):
        other = options.get(flag.swapcase())
        if f"({value})" in text and flag in options and getattr(other, "needs_value", False):
            meaning = getattr(other, "help", "").partition(".")[0]
            return f"did you mean {flag.swapcase()} {value}? {flag.swapcase()}: {meaning}"
    return ""


class Command(click.Command):
    """A Click command whose help groups its options, and whose wrong use raises ConfigError.

    Its callback gets the values of the shared options as the argument `settings`.

    Args:
        name: The name of the command.
        passes_arguments: Whether words after `--` are allowed: the program's arguments, which `settings` then contains.
        instead: Options that the command does not have, each with the one to use instead, for errors.
        **how: Other arguments of `click.Command`.
    """

    def __init__(
        self,
        name: str,
        *,
        passes_arguments: bool = False,
        instead: Mapping[str, str] = MappingProxyType({}),
        **how: Any,
    ) -> None:
        super().__init__(name, context_settings={"help_option_names": ["-h", "--help"]}, **how)
        self._passes_arguments = passes_arguments
        self.instead = instead
        self._shared = {
            option.name: option
            for option in self.params
            if isinstance(option, GroupedOption) and option.sets
        }

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Parse the words of the command as Click does, and return the words that are left.

        A short option may have its value after `=`, such as `-x=5`. The name of an option is refused as the value of
        another.
        """
        ctx.meta[_WORDS] = tuple(args)
        ours = args
        program = None
        if self._passes_arguments and ARGUMENTS_FOLLOW in args:
            index = args.index(ARGUMENTS_FOLLOW)
            ours = args[:index]
            program = tuple(args[index + 1 :])
        ours = [_ATTACHED.sub(r"\1", word) for word in ours]
        try:
            if not ctx.resilient_parsing:
                self._check_values(ctx, ours)
            rest = super().parse_args(ctx, ours)
        except click.UsageError as error:
            raise _convert_error(error, ctx) from None
        if self._shared:
            ctx.params["settings"] = self._collect_settings(ctx) | (
                {} if program is None else {"arguments": program}
            )
        return rest

    def _collect_settings(self, ctx: click.Context) -> dict[str, Any]:
        """Remove the shared options from Click's parameters.

        Return the values of those that the user gave, by the path of the setting.
        """
        settings: dict[str, Any] = {}
        for name in [name for name in ctx.params if name in self._shared]:
            value = ctx.params.pop(name)
            option = self._shared[name]
            if ctx.get_parameter_source(name) is ParameterSource.COMMANDLINE:
                value = tuple(chain(*value)) if option.multiple else value
                settings[option.sets] = (
                    (*settings.get(option.sets, ()), option.adds) if option.adds else value
                )
        return settings

    def _check_values(self, ctx: click.Context, words: Sequence[str]) -> None:
        known = {
            flag: param
            for param in self.get_params(ctx)
            for flag in param.opts
            if flag.startswith("-")
        }
        for word, value in pairwise(words):
            if value in known and getattr(known.get(word), "needs_value", False):
                raise click.BadOptionUsage(word, f"Option '{word}' requires an argument.", ctx)

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the options to the help, under the headings of their groups."""
        groups: dict[str, list[tuple[str, str]]] = {}
        for param in self.get_params(ctx):
            if isinstance(param, click.Option) and (record := param.get_help_record(ctx)):
                groups.setdefault(getattr(param, "group", GENERAL), []).append(record)
        for title, rows in groups.items():
            with formatter.section(title):
                formatter.write_dl(rows)


def command(*params: click.Parameter, **how: Any) -> Callable[[Callable[..., int]], Command]:
    """Return a decorator that makes a function a command: its docstring is the help, its result the exit code."""

    def make(work: Callable[..., int]) -> Command:
        attributes = {"name": work.__name__, "help": inspect.getdoc(work)} | how
        return Command(callback=work, params=list(params), **attributes)

    return make


class Group(click.Group):
    """A command with subcommands, which are imported when they are used.

    Args:
        listing: The help line of each subcommand.
        load: Returns the subcommand of a name.
        default: The subcommand that is used if none is named; empty if one must be named.
        instead: For words that are no subcommands, what to use instead.
    """

    def __init__(
        self,
        name: str,
        listing: Mapping[str, str],
        load: Callable[[str], click.Command],
        default: str = "",
        instead: Mapping[str, str] = MappingProxyType({}),
        **how: Any,
    ) -> None:
        settings = {"help_option_names": ["-h", "--help"]}
        how.setdefault("subcommand_metavar", "[COMMAND] …" if default else "COMMAND …")
        super().__init__(
            name, context_settings=settings, no_args_is_help=False, options_metavar="", **how
        )
        self.listing = listing
        self.load = load
        self.default = default
        self._instead = instead

    @classmethod
    def of(cls, name: str, commands: Sequence[click.Command], **how: Any) -> Self:
        """Return a group of commands that are already imported.

        Args:
            name: The name of the group.
            commands: Its subcommands.
            **how: Other arguments of the group.
        """
        by_name = {subcommand.name or "": subcommand for subcommand in commands}
        firsts = {
            called: (subcommand.help or "").partition("\n")[0]
            for called, subcommand in by_name.items()
        }
        listing = {called: first.partition(". ")[0].rstrip(".") for called, first in firsts.items()}
        return cls(name, listing, by_name.__getitem__, **how)

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the names of the subcommands."""
        return list(self.listing)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Import a subcommand and return it; None if there is none of this name."""
        return self.load(cmd_name) if cmd_name in self.listing else None

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the list of the subcommands to the help, without importing them."""
        with formatter.section("Commands"):
            formatter.write_dl(list(self.listing.items()))

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Parse the words after the group's name; return the words that are left, as Click does.

        The name of a subcommand may come after its options; the default subcommand need not be named.
        """
        if args or not ctx.resilient_parsing:
            args = self.insert_command(ctx, args)
        try:
            return super().parse_args(ctx, args)
        except click.UsageError as error:
            raise _convert_error(error, ctx) from None

    def insert_command(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Return the words with the subcommand's name first, even if its options came before it.

        If no subcommand is named, the default one is added; without a default, the words are returned unchanged.
        """
        if args and (not args[0].startswith("-") or args[0] in ctx.help_option_names):
            return args
        every = [
            param
            for name in self.listing
            for param in self.load(name).params
            if isinstance(param, click.Option)
        ]
        unique: list[click.Parameter] = list({param.opts[0]: param for param in every}.values())
        reader = click.Command(
            None, params=unique, context_settings={"allow_interspersed_args": False}
        )
        with reader.make_context("", list(args), resilient_parsing=True) as context:
            rest = context.args
        if rest:
            return [rest[0], *args[: len(args) - len(rest)], *rest[1:]]
        return [self.default, *args] if self.default else args

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Return the name of the subcommand in `args[0]`, the subcommand, and the words after it.

        If there is no such subcommand while the shell completes a word, the first two are None.

        Raises:
            ConfigError: there is no such subcommand, and the shell does not complete a word.
        """
        if args[0] in self.listing or ctx.resilient_parsing:
            return super().resolve_command(ctx, args)
        hint = self._instead.get(args[0]) or nearest(args[0], self.listing)
        raise ConfigError(f"no such command {args[0]!r}", hint, key=self.name or "")

    def invoke(self, ctx: click.Context) -> Any:
        """Run the named subcommand, and return its result.

        Raises:
            ConfigError: no subcommand is named.
        """
        try:
            return super().invoke(ctx)
        except click.UsageError:
            raise ConfigError(
                "no command given", f"one of {', '.join(self.listing)}", key=self.name or ""
            ) from None

    def shell_complete(self, ctx: click.Context, incomplete: str) -> list[CompletionItem]:
        """Return the completions of a word: subcommands, and words of the default subcommand."""
        completions = [
            CompletionItem(name, help=text)
            for name, text in self.listing.items()
            if name.startswith(incomplete)
        ]
        if not (self.default and incomplete):
            return completions
        default = self.load(self.default)
        if incomplete.startswith("-"):
            return default.shell_complete(ctx, incomplete)
        more = [
            item
            for param in default.params
            if isinstance(param, click.Argument)
            for item in param.shell_complete(ctx, incomplete)
        ]
        plain = [item for item in more if item.type == "plain"]
        if plain:
            return completions + plain
        if more:
            return _add_files(completions, incomplete)
        return completions


def drop_options(options: Sequence[click.Option]) -> list[str]:
    """Return the words of the command line that is being executed, without some options and their values.

    Args:
        options: The options to leave out, which have no short names.
    """
    flags = {flag for option in options for flag in option.opts}
    alone = {flag for option in options if option.is_flag for flag in option.opts}
    remaining: list[str] = []
    words = iter(click.get_current_context().meta[_WORDS])
    for word in words:
        if word == ARGUMENTS_FOLLOW:
            return [*remaining, word, *words]
        if word in flags:
            if word not in alone:
                next(words)
        elif word.partition("=")[0] not in flags:
            remaining.append(word)
    return remaining


def parse(command: Command, words: Sequence[str]) -> Arguments:
    """Return the arguments of a command that Click does not run, such as a magic.

    Args:
        command: The command.
        words: The words after its name.

    Raises:
        ConfigError: a word is no option, or a value is wrong.
    """
    with command.make_context(command.name, list(words)) as ctx:
        return Arguments(**ctx.params)


def build_help(command: Command) -> str:
    """Return the help of a command as text."""
    with command.make_context(command.name, [], resilient_parsing=True) as ctx:
        return command.get_help(ctx) + "\n"
