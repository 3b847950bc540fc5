"""The command line: parses arguments, calls a command, turns errors into exit codes.

To add a command: write its file in `commands/`, and add a line to `COMMANDS`.
"""

from __future__ import annotations

import errno
import os
import sys
from argparse import Namespace, RawDescriptionHelpFormatter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from difflib import get_close_matches
from importlib import import_module
from pathlib import Path

from tuisim import __version__
from tuisim.config.options import ARGUMENTS_FOLLOW, SwitchParser
from tuisim.errors import ConfigError, HostError, TuisimError, printable

COMMANDS: Mapping[str, str] = {
    "open": "open the app (the default command)",
    "run": "run programs without the app",
    "runs": "list, show, export or remove stored runs",
    "log": "analyse logs: statistics, bands, events, signals",
    "analyse": "explore logs in the app: table, chart, bands, notes",
    "backgrounds": "list the mats",
    "robots": "list the robots, or print one as a file",
    "obstacles": "list the sets of obstacles, or print one as a file",
    "programs": "list the example programs",
    "profiles": "list the profiles and the simulated time of each call",
    "kernel": "install the Jupyter kernel that runs a course's notebooks unchanged",
}
"""Every command and its help line."""

_FOR_PROGRAMS = ("open", "run")
"""Commands that pass the words after `--` to the program."""

LEAST_OPEN_FILES = 64
"""Open files that the app, a run and their libraries need, with some margin."""

EXIT_OUR_MISTAKE = 70
EXIT_INTERRUPTED, EXIT_BROKEN_PIPE = 130, 141
"""The exit codes of a program that was ended by SIGINT or SIGPIPE."""


class _HelpFormatter(RawDescriptionHelpFormatter):
    """Help in two columns, wide enough for one line per switch."""

    def __init__(self, prog: str) -> None:
        super().__init__(prog, max_help_position=36)


def _parser(command: str) -> SwitchParser:
    """Return the parser of one command; the help of `open` also lists the others."""
    if command == "open":
        listing = "\n".join(f"  tuisim {name:<12} {what}" for name, what in COMMANDS.items())
        parser = SwitchParser(
            prog="tuisim",
            usage="tuisim [WORLD.toml] [PROGRAM] [switches] [-- ARGUMENTS]\n       tuisim COMMAND …",
            description="A robot lab in the terminal: runs ev3dev2 programs on a simulated EV3 robot.",
            epilog=f"commands (each has its own --help):\n{listing}\n\n"
            "A program's magic line, such as `# %%sim_magic_preloaded -b Grey_bands`, can also hold switches.\n"
            "The command line takes precedence over a world file, the world file over the magic line.",
            formatter_class=_HelpFormatter,
            allow_abbrev=False,
        )
        parser.add_programs("words")
        parser.add_argument("--run", metavar="RUN", help="open a stored run, see `tuisim runs`")
        parser.add_argument("--version", action="version", version=f"tuisim {__version__}")
        parser.add_switches()
        return parser
    what = f"{COMMANDS[command].capitalize()}."
    parser = SwitchParser(
        prog=f"tuisim {command}", description=what, formatter_class=_HelpFormatter, allow_abbrev=False
    )
    import_module(f"tuisim.commands.{command}").add_arguments(parser)
    return parser


def _open(arguments: Namespace) -> int:
    """Start the app."""
    from tuisim.commands.notebooks import print_list, to_list
    from tuisim.commands.resolve import prepare_app, prepare_replay

    if listed := to_list(arguments.words):
        print_list(arguments.words[0], listed)
        return 0
    replay = None
    if arguments.run is None:
        prepared = prepare_app(arguments.words, arguments)
    else:
        replay, prepared = prepare_replay(arguments.run, arguments.words, arguments)
    if not (sys.stdin.isatty() and sys.stdout.isatty()):
        raise ConfigError("the app needs a terminal", "without one, use `tuisim run PROGRAM`")
    from tuisim.app.app import AppSettings, run_app

    settings = prepared.settings
    app_settings = AppSettings(
        spec=prepared.spec,
        settings=None if replay else settings,
        replay=replay,
        world_file=prepared.world.path if prepared.world else None,
        program=prepared.program,
        background=prepared.spec.world.background,
        panels_on=frozenset(settings.panels_on),
        panels_off=frozenset(settings.panels_off),
        autorun=settings.autorun,
        quiet=settings.quiet,
        rays=settings.rays,
        speed=1.0 if settings.speed is None else settings.speed,
        fps=settings.fps,
        colors=settings.colors,
    )
    with _drawing_on_stdout():
        return run_app(app_settings)


def _analyse(arguments: Namespace) -> int:
    """Start the analyser."""
    from tuisim.commands.analyse import asked

    what = asked(arguments)
    if not sys.stdout.isatty():
        raise ConfigError("the analyser needs a terminal", "without one, use `tuisim log`")
    from tuisim.analysis.source import LogRequest
    from tuisim.app.analyser.app import run_analyser
    from tuisim.logs.reader import STDIN

    if what.file == STDIN:
        _keys_from_terminal()
    wanted = LogRequest(
        what.file, what.runs, arguments.telemetry, arguments.time, tuple(arguments.value), arguments.unit
    )
    with _drawing_on_stdout():
        return run_analyser(wanted)


def _keys_from_terminal() -> None:
    """Read the log from the original standard input, and keys from the terminal."""
    try:
        terminal = os.open("/dev/tty", os.O_RDWR)
    except OSError as error:
        raise ConfigError("there is no terminal to read keys from", "name a file instead of -") from error
    sys.stdin = os.fdopen(os.dup(0))
    os.dup2(terminal, 0)
    os.close(terminal)


@contextmanager
def _drawing_on_stdout() -> Iterator[None]:
    """Redirect stderr to the terminal of stdout: Textual draws on stderr, which may be redirected to a file."""
    stderr = os.dup(2)
    os.dup2(1, 2)
    try:
        yield
    finally:
        os.dup2(stderr, 2)
        os.close(stderr)


def _check_command(word: str) -> None:
    """Raise ConfigError if a word looks like a misspelt command and is not a program."""
    close = get_close_matches(word, COMMANDS, 1)
    if not close or "." in word:
        return
    from tuisim.commands.resolve import find_program

    if not find_program(word).exists():
        raise ConfigError(f"{word}: no such command or program", f"did you mean `tuisim {close[0]}`?")


def _check_open_files() -> None:
    """Raise HostError if the shell's limit of open files is too low; raise the soft limit if it can be raised."""
    import resource

    allowed, most = resource.getrlimit(resource.RLIMIT_NOFILE)
    if not 0 <= allowed < LEAST_OPEN_FILES:
        return
    try:
        resource.setrlimit(resource.RLIMIT_NOFILE, (LEAST_OPEN_FILES, most))
    except (OSError, ValueError):
        hint = f"tuisim needs {LEAST_OPEN_FILES}: ulimit -n {LEAST_OPEN_FILES}"
        raise HostError(f"this shell allows no more than {allowed} open files", hint) from None


def _dispatch(words: Sequence[str]) -> int:
    _check_open_files()
    command, rest = (words[0], words[1:]) if words and words[0] in COMMANDS else ("open", words)
    if words and command != words[0]:
        _check_command(words[0])
    # Intermixed, because switches may appear between two programs.
    given, ours = None, list(rest)
    if command in _FOR_PROGRAMS and ARGUMENTS_FOLLOW in ours:
        at = ours.index(ARGUMENTS_FOLLOW)
        given, ours = tuple(ours[at + 1 :]), ours[:at]
    arguments = _parser(command).parse_intermixed_args(ours)
    if given is not None:
        from tuisim.commands.resolve import check_arguments

        arguments.arguments = given
        check_arguments(arguments.words if command == "open" else arguments.programs, arguments)
    if command == "open":
        return _open(arguments)
    if command == "analyse":
        return _analyse(arguments)
    return int(import_module(f"tuisim.commands.{command}").execute(arguments))


def _silence_stdout() -> None:
    """Prevent an error about a closed pipe when the interpreter flushes stdout at exit."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _flushed() -> bool:
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
    # A shell may close them; the output is then discarded.
    sys.stdout = sys.stdout or Path(os.devnull).open("w")  # noqa: SIM115 - open until the process ends
    sys.stderr = sys.stderr or Path(os.devnull).open("w")  # noqa: SIM115
    for stream in (sys.stdout, sys.stderr):
        # Output that the terminal cannot encode must not raise.
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")
    try:
        code = _dispatch(words)
        return code if _flushed() else max(code, TuisimError.exit_code)
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
            print(f"tuisim: cannot write: {error.strerror}", file=sys.stderr)
            return TuisimError.exit_code
        if os.environ.get("TUISIM_DEBUG"):
            raise
        text = printable(f"{type(error).__name__}: {error}")
        print(f"tuisim: internal error: {text} (TUISIM_DEBUG=1 shows the traceback)", file=sys.stderr)
        return EXIT_OUR_MISTAKE
