"""`tuisim run`: programs without the app, one after another."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Sequence
from typing import Any

from tuisim.base.errors import (
    SIGNALLED,
    ConfigError,
    ExportError,
    LogError,
    TuisimError,
    counted,
    shortened,
)
from tuisim.base.source import source_lines
from tuisim.commands import exit_status
from tuisim.commands.echo import Progress, echo_error, echo_written, is_watched, tell
from tuisim.commands.exit_status import handle_signals
from tuisim.commands.listings import COLUMN, WORLD, list_names
from tuisim.commands.notebooks import NotRun, find_listed, print_list, print_results
from tuisim.commands.relay import Follower, RelayInterrupts, is_piped, read_answer
from tuisim.commands.resolve import Prepared, check_arguments, prepare_runs
from tuisim.commands.run_options import build_input_option, build_timeout_option
from tuisim.engine.breakpoints import Breakpoint, parse_watch
from tuisim.engine.core.profile import NS_PER_S
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM, RunSpec
from tuisim.engine.protocol import Answer, InputWanted, Inspect, Inspected, Message, Paused, Resume
from tuisim.engine.runs.handle import RunHandle, RunOptions, start_run
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.store import RunStore
from tuisim.logs.export import EXPORTERS, check_targets, export_samples, export_telemetry
from tuisim.settings.build import list_ineffective
from tuisim.settings.command_line import Arguments, WordType, argument, choice, command, option
from tuisim.settings.presses import press_actions
from tuisim.settings.shared_options import build_shared_options
from tuisim.settings.user_config import FILE, Section, UserConfig

MAX_CHARACTERS = 200
GO = "go"
STOP = "stop"

_REPORTS = "Data and limits"
_BREAKPOINTS = "Breakpoints"
_OPTIONS = (
    argument("programs", "PROGRAM…", lambda: list_names("programs"), nargs=-1),
    WORLD,
    option(
        "--export",
        multiple=True,
        metavar="FILE",
        type=WordType(),
        group=_REPORTS,
        help=f"Write the samples of all programs ({', '.join(EXPORTERS)}); may be repeated.",
    ),
    option(
        "--telemetry",
        metavar="FILE",
        type=WordType(),
        group=_REPORTS,
        help="Write the telemetry of a single program, one row per tick.",
    ),
    build_timeout_option(_REPORTS),
    build_input_option(_REPORTS),
    option(
        "--all",
        is_flag=True,
        group=_REPORTS,
        help="Run all program cells of a notebook, or of a folder's notebooks; print a table.",
    ),
    option(
        "--json",
        is_flag=True,
        group=_REPORTS,
        help="Print one JSON object per program; program output goes to stderr.",
    ),
    option(
        "--strict",
        is_flag=True,
        group=_REPORTS,
        help="Run nothing if a program for LEGO's MicroPython has a line that the brick's Python would refuse.",
    ),
    option(
        "--break",
        "breaks",
        multiple=True,
        metavar="TEXT",
        type=COLUMN,
        group=_BREAKPOINTS,
        help="Set a breakpoint, reported on stderr: 12, 12 if x > 3, left_red_pc < 10, left_color changes, "
        "ultrasonic < 200, sample Colour < 50, print matches REGEX, time 3.5, stall; may be repeated.",
    ),
    option(
        "--watch",
        "watches",
        multiple=True,
        metavar="EXPR",
        type=COLUMN,
        group=_BREAKPOINTS,
        help="Evaluate an expression at each breakpoint; may be repeated.",
    ),
    choice(
        "--break-then",
        (GO, STOP),
        default=GO,
        group=_BREAKPOINTS,
        help="What to do after a breakpoint (go); stop ends the run with exit code 3.",
    ),
)


@command(
    *_OPTIONS,
    *build_shared_options(without_app=True, names=list_names),
    passes_arguments=True,
    help="""Run programs without the app.

    A PROGRAM is a Python file, a notebook, one of its cells (FILE.ipynb#2), a world file or an example by name. Its
    output goes to stdout, everything else to stderr; the words after -- are its arguments.

    A program from a real robot gets the robot that it describes, unless -r names one: see tuisim robots --from, and
    tuisim guide real-programs.

    Exit code: 0 finished, 1 the program raised an exception, 2 bad input, 3 stopped by a limit or a breakpoint; with
    several programs, the highest code.
    """,
)
def run(**given: Any) -> int:
    """Run the programs and return the worst exit code.

    Raises:
        ConfigError: a program, a world, a mat or an option is wrong; nothing was run.
        ExportError: a target cannot be written; checked before anything is run.
        HostError: a child process could not be started, or sent invalid data.
    """
    arguments = Arguments(**given)
    check_arguments(arguments.programs, arguments)
    if listed := find_listed(arguments.programs, run_all=arguments.all):
        _check_only_listed(arguments, len(listed))
        print_list(arguments.programs[0], listed)
        return 0
    # All input is checked before the first program runs.
    prepared = prepare_runs(
        arguments.programs,
        arguments,
        config=UserConfig.load().checked().keep_section(Section.SIMULATION),
    )
    for remark in dict.fromkeys(
        candidate.from_config
        for candidate in prepared
        if isinstance(candidate, Prepared) and candidate.from_config
    ):
        echo_error(f"note: from {FILE}: {', '.join(remark)}")
    to_run = [candidate for candidate in prepared if isinstance(candidate, Prepared)]
    _tell_notes(to_run, strict=arguments.strict)
    check_breaks(arguments.breaks, arguments.watches, to_run)
    telemetry = arguments.telemetry
    check_targets(target for target in (*arguments.export, telemetry) if target is not None)
    if telemetry is not None and len(prepared) > 1:
        raise ConfigError("takes one program", f"got {len(prepared)}", key="--telemetry")
    store = RunStore()
    interrupts = RelayInterrupts()
    with handle_signals(interrupts.handle), Progress(""):
        code, results = _run_all(prepared, arguments, store, interrupts)
        if done := [run for _, run in results if run is not None]:
            _export(done, arguments)
        if arguments.all and not arguments.json:
            print_results(results)
    return max(code, interrupts.exit_code)


def _tell_notes(prepared: Sequence[Prepared], *, strict: bool) -> None:
    """Print which settings the programs themselves decide, and which of their lines the brick would refuse.

    Args:
        prepared: The programs.
        strict: Whether a refused line is an error.

    Raises:
        ConfigError: the brick would refuse a line, and `strict` is true.
    """
    decided = [program.decided for program in prepared]
    if strict and (refused := next(filter(None, (program.refusal for program in decided)), "")):
        raise ConfigError(refused, "leave out --strict to run it")
    notes = [note for program in decided for note in (program.note, program.refusal)]
    for each in prepared:
        notes += [_describe_start(each.spec), *list_ineffective(each.spec)]
    for note in dict.fromkeys(filter(None, notes)):
        echo_error(f"note: {note}")


def _describe_start(spec: RunSpec) -> str:
    """Return a note that the robot starts outside the mat; empty if it does not."""
    start = spec.world.start
    is_on = 0 <= start.x_mm <= FIELD_WIDTH_MM and 0 <= start.y_mm <= FIELD_HEIGHT_MM
    size = f"{FIELD_WIDTH_MM} × {FIELD_HEIGHT_MM} mm"
    return "" if is_on else f"the robot starts outside the mat, which is {size}"


def check_breaks(
    texts: Sequence[str], watches: Sequence[str], prepared: Iterable[Prepared]
) -> None:
    """Check breakpoints and watches before any program is run.

    Args:
        texts: The breakpoints.
        watches: The expressions to watch.
        prepared: The programs.

    Raises:
        ConfigError: a text is not a breakpoint, or not valid for a program or its robot; a watch is not an expression,
            or there are watches without breakpoints.
    """
    for candidate in prepared:
        lines = source_lines(candidate.program.text if candidate.program else "")
        for text in texts:
            Breakpoint.parse(text, candidate.spec).check_line(lines)
    for watch in watches:
        parse_watch(watch)
    if watches and not texts:
        raise ConfigError(
            "needs a breakpoint", "add one with --break, such as --break 'time 1'", key="watch"
        )


class BreakpointReporter:
    """Reports on stderr each time that a run stops at a breakpoint.

    Args:
        watches: Expressions to evaluate at each breakpoint.
        stops: Whether the first breakpoint ends the run.
    """

    def __init__(self, handle: RunHandle, watches: tuple[str, ...], *, stops: bool) -> None:
        self._handle = handle
        self._watches = watches
        self._stops = stops
        self._paused: Paused | None = None
        self._source = source_lines(handle.program.text)
        self.stopped = False
        """Whether a breakpoint has ended the run."""

    def handle(self, event: Message) -> None:
        """When a run has paused, request its values; when these have come, report them, and resume or stop the run."""
        match event:
            case Paused():
                self._paused = event
                self._handle.send(Inspect(self._watches))
            case Inspected() if self._paused is not None:
                for line in self._report(self._paused, event):
                    echo_error(line)
                self._paused = None
                self._resume()

    def _resume(self) -> None:
        if self._stops:
            self.stopped = True
            self._handle.stop()
        else:
            self._handle.send(Resume())

    def _report(self, paused: Paused, inspected: Inspected) -> list[str]:
        """Return the lines of the report: position, variables, watches, and what the program waits for."""
        name = paused.file or self._handle.program.file
        value = f" ({paused.value})" if paused.value else ""
        thread = f", thread {paused.thread}" if len(inspected.threads) > 1 else ""
        last = self._handle.telemetry.last()
        pose = f", {last.pose.describe()}" if last else ""
        where = f"{name}:{paused.line}, {paused.time_ns / NS_PER_S:.3f} s, tick {paused.tick}{pose}{thread}"
        lines = [f"break {paused.detail}{value}: {where}"]
        if not paused.file and 0 < paused.line <= len(self._source):
            lines.append(f"    {paused.line} | {self._source[paused.line - 1].strip()}")
        lines += [f"    {variable.name} = {variable.value}" for variable in inspected.variables]
        lines += [f"    {watch.text} → {watch.value or watch.error}" for watch in inspected.watches]
        lines += [f"    {note}" for note in (inspected.waiting, inspected.note) if note]
        return [lines[0], *(shortened(line, MAX_CHARACTERS) for line in lines[1:])]


def _export(done: Sequence[StoredRun], arguments: Arguments) -> None:
    """Write every export of the finished runs to its file.

    A failure does not prevent the other exports. The first failure is raised at the end, others are printed on stderr.
    """
    writers: list[tuple[str, Callable[[str], int]]] = [
        (target, lambda target: export_samples(done, target)) for target in arguments.export
    ]
    if arguments.telemetry is not None:
        writers.append((arguments.telemetry, lambda target: export_telemetry(done[0], target)))
    errors: list[TuisimError] = []
    for target, write in writers:
        tell(f"writing {target}")
        try:
            write(target)
            echo_written(target)
        except (ExportError, LogError) as error:
            errors.append(error)
        except KeyboardInterrupt:
            option = "--telemetry" if target == arguments.telemetry else "--out"
            again = (
                f"tuisim runs export {' '.join(str(run.number) for run in done)} {option} {target}"
            )
            echo_error(f"tuisim: {target} was not written; the log is stored ({again})")
            raise
    for other in errors[1:]:
        echo_error(f"tuisim: {other}")
    if errors:
        raise errors[0]


def _check_only_listed(arguments: Arguments, count: int) -> None:
    """Raise ConfigError if the arguments request an export or JSON while the programs of a notebook are only listed."""
    if arguments.json or arguments.export or arguments.telemetry is not None:
        (word,) = arguments.programs
        raise ConfigError(
            f"has {counted(count, 'program cell')}; name one", f"--all, or {word}#1", file=word
        )


def _run_all(
    prepared: Sequence[Prepared | NotRun],
    arguments: Arguments,
    store: RunStore,
    interrupts: RelayInterrupts,
) -> tuple[int, list[tuple[str, StoredRun | None]]]:
    """Run the programs one after another until all are done or interrupted.

    Returns:
        The highest exit code, and for each program its label and its run; the run is None if it could not be run.
    """
    results: list[tuple[str, StoredRun | None]] = []
    code = 0
    for number, program in enumerate(prepared):
        if isinstance(program, NotRun):
            program.report(as_json=arguments.json)
            results.append((program.label, None))
            code = max(code, exit_status.EXIT_BAD_OUTPUT)
            continue
        how_far = _build_progress(number, len(prepared))
        exit_code, handle = _run_one(program, arguments, store, interrupts, how_far)
        try:
            run = handle.stored()
        except LogError:
            echo_error(
                f"tuisim: {handle.program.name}: run {handle.number} was not stored: {handle.unstored}"
            )
            exit_code = exit_status.choose_unstored_code(exit_code)
        else:
            results.append((program.label or run.program.name, run))
            exit_status.report(run, exit_code, as_json=arguments.json)
        code = max(code, exit_code)
        if exit_code > SIGNALLED:
            break
    return code, results


def _build_progress(number: int, count: int) -> Callable[[RunHandle], None]:
    """Return a function that shows the progress of a run.

    Args:
        number: The index of the run among all runs of the command, from 0.
        count: The number of runs.
    """

    def tell_run(handle: RunHandle) -> None:
        ticks = handle.telemetry.count
        what = f"{handle.program.name}: {ticks / handle.spec.profile.tick_hz:.1f} s simulated"
        # The bar counts programs, as it is unknown how long a program takes.
        tell(
            f"{number + 1} of {count}, {what}" if count > 1 else what,
            number,
            count if count > 1 else None,
        )

    return tell_run if is_watched() else lambda _: None


def _choose_options(prepared: Prepared, arguments: Arguments) -> RunOptions:
    """Return the options of a program's run.

    If no answers are given, the lines of a pipe or file on stdin answer `input()`.
    """
    speed = prepared.settings["speed"] or 0.0
    answers = arguments.input or (prepared.world.inputs if prepared.world else ())
    asks_pipe = not answers and is_piped()
    return RunOptions(
        live=speed > 0,
        speed=speed,
        time_limit_s=arguments.timeout,
        answers=answers,
        actions=press_actions(prepared.settings["press"], prepared.spec.profile.tick_hz),
        breaks=arguments.breaks,
        asks_user=asks_pipe,
        time_waits=asks_pipe,
    )


def _run_one(
    prepared: Prepared,
    arguments: Arguments,
    store: RunStore,
    interrupts: RelayInterrupts,
    how_far: Callable[[RunHandle], None],
) -> tuple[int, RunHandle]:
    assert prepared.program is not None
    options = _choose_options(prepared, arguments)
    handle = start_run(prepared.program, prepared.spec, options, store)
    interrupts.watch(handle)
    reporter = BreakpointReporter(handle, arguments.watches, stops=arguments.break_then == STOP)

    def listen(event: Message) -> None:
        if isinstance(event, InputWanted):
            handle.send(Answer(read_answer()))
        else:
            reporter.handle(event)

    try:
        out = sys.stderr if arguments.json else sys.stdout
        is_heard = options.breaks or options.asks_user
        follower = Follower(handle, out, listen if is_heard else None, how_far)
        ended = follower.follow_to_end()
    finally:
        handle.close()
    if follower.lost:
        echo_error(f"tuisim: {follower.lost} (run {handle.number} contains every line)")
    ended_code = exit_status.choose_exit_code(ended.end, ended.exit_code)
    if reporter.stopped:
        ended_code = exit_status.EXIT_LIMIT
    code = interrupts.exit_code or follower.cut or ended_code
    if handle.unstored:
        code = exit_status.choose_unstored_code(code)
    return max(code, exit_status.EXIT_BAD_OUTPUT) if follower.lost else code, handle
