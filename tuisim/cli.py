"""The command line: parses arguments, calls a command, turns errors into exit codes.

To add a command: write it in `commands/`, and add a line to `COMMANDS`.
"""

from __future__ import annotations

import errno
import os
import sys
from collections.abc import Mapping, Sequence
from importlib import import_module
from pathlib import Path
from typing import cast

import click
from click.shell_completion import get_completion_class, shell_complete

from tuisim import __version__
from tuisim.base.data_class import dataclass
from tuisim.base.errors import (
    EXIT_BROKEN_PIPE,
    SIGNALLED,
    ConfigError,
    HostError,
    TuisimError,
    closest,
    did_you_mean,
    printable,
    shortened,
)
from tuisim.settings.command_line import Group, command

EXIT_INTERRUPTED = SIGNALLED + 2


@dataclass(frozen=True, slots=True)
class CommandEntry:
    """Where the function of a command is, and what the command does, so that it is imported only when it is called."""

    path: str
    """MODULE:NAME, imported on use."""
    does: str

    def load(self) -> click.Command:
        """Import the command and return it."""
        module, _, name = self.path.partition(":")
        return cast("click.Command", getattr(import_module(f"tuisim.{module}"), name))


COMMANDS: Mapping[str, CommandEntry] = {
    "open": CommandEntry("commands.app:open_app", "Open the app (the default command)"),
    "serve": CommandEntry("commands.serve:serve", "Open the app in a browser"),
    "run": CommandEntry("commands.run:run", "Run programs without the app"),
    "batch": CommandEntry(
        "commands.batch:batch", "Run programs with many seeds and settings; one row per run"
    ),
    "runs": CommandEntry("commands.runs:runs", "List, show, export, draw or remove stored runs"),
    "goals": CommandEntry("commands.goals:goals", "Check whether runs meet the goals of a task"),
    "mark": CommandEntry(
        "commands.mark:mark", "Mark the programs of a class by the goals of a task"
    ),
    "learn": CommandEntry("commands.learn:learn", "Learn to program the robot: lessons in the app"),
    "guide": CommandEntry(
        "commands.guide:guide", "Read the guide: tutorials, how-to pages, reference"
    ),
    "log": CommandEntry("commands.log:log", "Analyse logs: statistics, bands, events, signals"),
    "analyse": CommandEntry(
        "commands.app:analyse", "Explore logs in the app: table, chart, bands, notes"
    ),
    "backgrounds": CommandEntry("commands.listings:backgrounds", "List the mats"),
    "robots": CommandEntry("commands.listings:robots", "List the robots, or print one as a file"),
    "obstacles": CommandEntry(
        "commands.listings:obstacles", "List the sets of obstacles, or print one as a file"
    ),
    "programs": CommandEntry("commands.listings:programs", "List the example programs"),
    "profiles": CommandEntry(
        "commands.listings:profiles", "List the profiles and the simulated time of each call"
    ),
    "kernel": CommandEntry(
        "commands.kernel:kernel", "Install the Jupyter kernel for a course's notebooks"
    ),
    "config": CommandEntry(
        "commands.system.user_config:config", "Show your settings, and where each comes from"
    ),
    "doctor": CommandEntry(
        "commands.system.doctor:doctor", "Check the terminal and the machine; restore a terminal"
    ),
    "completion": CommandEntry(
        "cli:completion", "Print a script that completes commands in your shell"
    ),
}

_COMPLETE = "_TUISIM_COMPLETE"
"""The environment variable with which a completion script asks for words."""

MIN_OPEN_FILES = 64
"""Open files that the app, a run and their libraries need, with some margin."""

EXIT_OUR_MISTAKE = 70
_INSTEAD = {"man": "`tuisim --help` lists the commands, `tuisim guide commands` explains them"}
"""What to use instead of commands that there are not."""
_GROUPS = ("runs", "log", "goals", "learn")
"""Commands with subcommands that are taken for commands."""
_SYNONYMS = {"compare": "diff", "delete": "rm", "remove": "rm", "chart": "plot", "replay": "rerun"}
"""Words for subcommands."""


def _find_commands(word: str, others: Sequence[str]) -> list[str]:
    """Return the commands that a user may have meant by a mistyped word, such as `` `tuisim log bands` ``; at most two.

    The best one is first.

    Args:
        word: The first word of the command line.
        others: The words after it.
    """
    action = _SYNONYMS.get(word, word)
    rest = "".join(f" {other}" for other in others)
    if action == "export" and "--out" not in others:
        rest += " --out FILE"
    groups = [name for name in _GROUPS if action in cast("Group", COMMANDS[name].load()).listing]
    lines = [f"`tuisim {name} {action}{rest}`" for name in groups]
    return lines[:2] or [f"`tuisim {name}`" for name in closest(word, COMMANDS, 1)]


def _check_command(word: str, others: Sequence[str]) -> None:
    """Check the first word of the command line, unless it is a program.

    Raises:
        ConfigError: it looks like a misspelt command, or like a command of a group.
    """
    from tuisim.programs.program_file import find_program

    if "." in word or os.path.exists(find_program(word)):
        return
    if hint := _INSTEAD.get(word) or did_you_mean(_find_commands(word, others)):
        raise ConfigError(f"{word}: no such command or program", hint)


def _check_open_files() -> None:
    """Raise the soft limit of open files if it is too low.

    Raises:
        HostError: it is too low and cannot be raised.
    """
    import resource

    allowed, hard_limit = resource.getrlimit(resource.RLIMIT_NOFILE)
    if not 0 <= allowed < MIN_OPEN_FILES:
        return
    try:
        resource.setrlimit(resource.RLIMIT_NOFILE, (MIN_OPEN_FILES, hard_limit))
    except (OSError, ValueError):
        hint = f"tuisim needs {MIN_OPEN_FILES}: ulimit -n {MIN_OPEN_FILES}"
        raise HostError(f"this shell allows no more than {allowed} open files", hint) from None


class _Root(Group):
    """The command `tuisim`: a word that is no command is for `open`, or for `analyse` if it names a log."""

    def insert_command(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Return the words with `open` or, for a log, `analyse` first.

        They are returned as they are if they begin with a command or an option of `tuisim` itself.
        """
        if args and (args[0] in COMMANDS or args[0] in ("-h", "--help", "--version")):
            return args
        if args and not args[0].startswith("-") and not ctx.resilient_parsing:
            from tuisim.programs.program_file import LOG_SUFFIXES

            if Path(args[0]).suffix.lower() in LOG_SUFFIXES:
                return ["analyse", *args]
            _check_command(args[0], args[1:])
        return [self.default, *args]


ROOT = _Root(
    "tuisim",
    {name: entry.does for name, entry in COMMANDS.items()},
    lambda name: COMMANDS[name].load(),
    default="open",
    help="""A robot lab in the terminal: runs ev3dev2 and Pybricks programs on a simulated EV3 robot.

    Without a command, `tuisim [WORLD.toml] [PROGRAM] [OPTIONS] [-- ARGUMENTS]` opens the app; `tuisim open --help`
    lists its options.
    """,
)
click.version_option(
    __version__, prog_name="tuisim", message="%(prog)s %(version)s", help="Print the version."
)(ROOT)


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
    """Print the shell's completion script."""
    scripts = get_completion_class(shell)
    assert scripts is not None
    print(scripts(ROOT, {}, "tuisim", _COMPLETE).source())
    return 0


def _dispatch(words: Sequence[str]) -> int:
    _check_open_files()
    if instruction := os.environ.get(_COMPLETE):
        return shell_complete(ROOT, {}, "tuisim", _COMPLETE, instruction)
    try:
        with ROOT.make_context("tuisim", list(words)) as context:
            return int(ROOT.invoke(context))
    except click.exceptions.Exit as done:
        return done.exit_code


def _silence_stdout() -> None:
    """Prevent an error about a closed pipe when the interpreter flushes stdout at exit."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _flush_stdout() -> bool:
    """Flush stdout; print an error and return False if that fails."""
    try:
        sys.stdout.flush()
    except BrokenPipeError:
        raise
    except OSError as error:
        _silence_stdout()
        print(f"tuisim: cannot write to stdout: {error.strerror or error}", file=sys.stderr)
        return False
    return True


def run_command(words: Sequence[str]) -> int:
    """Run one command and return its exit code; expected errors become one line on stderr.

    Args:
        words: The command line without the program's own name.
    """
    # A shell may close stdout or stderr; the output is then discarded.
    sys.stdout = sys.stdout or Path(os.devnull).open("w")  # noqa: SIM115 - open until the process ends
    sys.stderr = sys.stderr or Path(os.devnull).open("w")  # noqa: SIM115
    for stream in (sys.stdout, sys.stderr):
        # Output that the terminal cannot encode must not raise.
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")
    try:
        code = _dispatch(words)
        return code if _flush_stdout() else max(code, TuisimError.exit_code)
    except TuisimError as error:
        print("tuisim:", " ".join(str(error).split("\n")), file=sys.stderr)
        return error.exit_code
    except BrokenPipeError:
        _silence_stdout()
        return EXIT_BROKEN_PIPE
    except KeyboardInterrupt:
        return EXIT_INTERRUPTED
    # A bug in tuisim: one line for the user, the traceback on request.
    except Exception as error:
        if isinstance(error, OSError) and error.errno in (errno.ENOSPC, errno.EIO):
            _silence_stdout()
            what = f"{error.filename}:" if error.filename else "cannot write:"
            print(f"tuisim: {what} {error.strerror}", file=sys.stderr)
            return TuisimError.exit_code
        if os.environ.get("TUISIM_DEBUG"):
            raise
        text = printable(shortened(f"{type(error).__name__}: {error}"))
        print(
            f"tuisim: internal error: {text} (TUISIM_DEBUG=1 shows the traceback)", file=sys.stderr
        )
        return EXIT_OUR_MISTAKE
