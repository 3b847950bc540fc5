"""`tuisim run`: programs without the app, one after another."""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Callable, Sequence

from tuisim.commands import exit_status
from tuisim.commands.breakpoints import STOP, BreakOptions, BreakTeller, add_break_arguments, check_breaks
from tuisim.commands.echo import echo_error
from tuisim.commands.notebooks import NotRun, print_list, print_results, to_list
from tuisim.commands.outputs import check_targets
from tuisim.commands.press import parse_press, press_actions
from tuisim.commands.progress import Progress, is_watched, tell
from tuisim.commands.relay import Follower, Interrupts
from tuisim.commands.resolve import Prepared, prepare_runs
from tuisim.config.options import SwitchParser, number
from tuisim.errors import ConfigError, ExportError, LogError, TuisimError, counted
from tuisim.logs.export import EXPORTERS, export_samples, export_telemetry
from tuisim.runs.handle import RunHandle, RunOptions, start_run
from tuisim.runs.run_folder import StoredRun
from tuisim.runs.store import RunStore

MAX_TIME_LIMIT_S = 1e6
DEFAULT_TIME_LIMIT_S = 600.0


def add_arguments(parser: SwitchParser) -> None:
    """Declare the arguments of `tuisim run`."""
    limit = number(0.001, MAX_TIME_LIMIT_S)
    parser.description = (
        "Run programs without the app. Program output goes to stdout, the rest to stderr. Exit "
        "code: 0 finished, 1 the program raised, 2 bad input, 3 stopped by a limit or breakpoint (the worst counts)."
    )
    parser.usage = "tuisim run [WORLD.toml] PROGRAM… [switches] [--export FILE]… [--json] … [-- ARGUMENTS]"
    parser.add_programs("programs")
    add = parser.add_argument_group("data and limits").add_argument
    add("--export", action="append", default=[], metavar="FILE",
        help=f"write the samples of all programs ({', '.join(EXPORTERS)}); may be repeated")  # fmt: skip
    add("--telemetry", metavar="FILE", help="write the telemetry of a single program, one row per tick")
    add("--timeout", default=DEFAULT_TIME_LIMIT_S, metavar="S", type=lambda text: limit(text, "--timeout"),
        help=f"simulated seconds allowed ({DEFAULT_TIME_LIMIT_S:g})")  # fmt: skip
    add("--input", action="append", default=[], metavar="TEXT", help="answer an input(); may be repeated")
    add("--press", action="append", default=[], metavar="BUTTON@S", type=parse_press,
        help="press a button of the brick: enter@1.0-1.5, or enter@1 for 0.1 s; may be repeated")  # fmt: skip
    add_break_arguments(parser)
    add(
        "--all",
        action="store_true",
        help="run all program cells of a notebook, or of a folder's notebooks; print a table",
    )
    add("--json", action="store_true", help="print one JSON object per program; program output goes to stderr")
    parser.add_switches()


def execute(arguments: Namespace) -> int:
    """Run the programs and return the worst exit code.

    Raises:
        ConfigError: a program, a world, a mat or a switch is wrong; nothing was run.
        ExportError: a target cannot be written; checked before anything is run.
        HostError: a child process could not be started, or sent invalid data.
    """
    if listed := to_list(arguments.programs, run_all=arguments.all):
        _check_only_listed(arguments, len(listed))
        print_list(arguments.programs[0], listed)
        return 0
    # All input is checked before the first program runs.
    prepared = prepare_runs(arguments.programs, arguments)
    check_breaks(arguments.breaks, arguments.watches, [one for one in prepared if isinstance(one, Prepared)])
    telemetry = arguments.telemetry
    check_targets(target for target in (*arguments.export, telemetry) if target is not None)
    if telemetry is not None and len(prepared) > 1:
        raise ConfigError("takes one program", f"got {len(prepared)}", key="--telemetry")
    store = RunStore()
    with Interrupts() as interrupts, Progress(""):
        code, results = _run_all(prepared, arguments, store, interrupts)
        if done := [run for _, run in results if run is not None]:
            _export(done, arguments)
        if arguments.all and not arguments.json:
            print_results(results)
    return max(code, interrupts.exit_code)


def _export(done: Sequence[StoredRun], arguments: Namespace) -> None:
    """Write every export; report failures on stderr, and raise the first after all have been tried."""
    writers: list[tuple[str, Callable[[str], None]]] = [
        (target, lambda target: export_samples(done, target)) for target in arguments.export
    ]
    if arguments.telemetry is not None:
        writers.append((arguments.telemetry, lambda target: export_telemetry(done[0], target)))
    errors: list[TuisimError] = []
    for target, write in writers:
        tell(f"writing {target}")
        try:
            write(target)
        except (ExportError, LogError) as error:
            errors.append(error)
        except KeyboardInterrupt:
            option = "--telemetry " if target == arguments.telemetry else ""
            again = f"tuisim runs export {' '.join(str(run.number) for run in done)} {option}{target}"
            echo_error(f"tuisim: {target} was not written; the log is stored ({again})")
            raise
    for other in errors[1:]:
        echo_error(f"tuisim: {other}")
    if errors:
        raise errors[0]


def _check_only_listed(arguments: Namespace, count: int) -> None:
    """Raise ConfigError if an export or JSON is asked for where a notebook is only listed."""
    if arguments.json or arguments.export or arguments.telemetry is not None:
        (word,) = arguments.programs
        raise ConfigError(f"has {counted(count, 'program cell')}; name one", f"--all, or {word}#1", file=word)


def _run_all(
    prepared: Sequence[Prepared | NotRun], arguments: Namespace, store: RunStore, interrupts: Interrupts
) -> tuple[int, list[tuple[str, StoredRun | None]]]:
    """Run the programs in turn until done or interrupted; return the worst exit code, and (label, run) pairs."""
    results: list[tuple[str, StoredRun | None]] = []
    code = 0
    for at, one in enumerate(prepared):
        if isinstance(one, NotRun):
            one.report(as_json=arguments.json)
            results.append((one.label, None))
            code = max(code, exit_status.EXIT_BAD_OUTPUT)
            continue
        how_far = _how_far(at, len(prepared))
        exit_code, handle = _run_one(one, arguments, store, interrupts, how_far)
        if handle.folder.is_dir():
            run = handle.stored()
            results.append((one.label or run.program.name, run))
            exit_status.report(run, exit_code, as_json=arguments.json)
        else:
            echo_error(f"tuisim: {handle.program.name}: run {handle.number} was not stored: {handle.unstored}")
        code = max(code, exit_code)
        if exit_code > exit_status.SIGNALLED:
            break
    return code, results


def _how_far(number: int, count: int) -> Callable[[RunHandle], None]:
    """Return a callback that shows the progress of one of several runs."""

    def tell_run(handle: RunHandle) -> None:
        ticks = handle.telemetry.count
        what = f"{handle.program.name}: {ticks / handle.spec.profile.tick_hz:.1f} s simulated"
        # The length of a program is unknown; only their number is known.
        tell(f"{number + 1} of {count}, {what}" if count > 1 else what, number, count if count > 1 else None)

    return tell_run if is_watched() else lambda _: None


def _run_one(
    one: Prepared, arguments: Namespace, store: RunStore, interrupts: Interrupts, how_far: Callable[[RunHandle], None]
) -> tuple[int, RunHandle]:
    """Run one program to its end; return exit code and run."""
    assert one.program is not None
    speed = one.settings.speed or 0.0
    options = RunOptions(
        live=speed > 0,
        speed=speed,
        time_limit_s=arguments.timeout,
        answers=tuple(arguments.input),
        actions=press_actions(arguments.press, one.spec.profile.tick_hz),
        breaks=tuple(arguments.breaks),
    )
    handle = start_run(one.program, one.spec, options, store)
    interrupts.watch(handle)
    stops = arguments.break_then == STOP
    teller = BreakTeller(handle, BreakOptions(options.breaks, tuple(arguments.watches), stops))
    try:
        out = sys.stderr if arguments.json else sys.stdout
        follower = Follower(handle, out, teller.take if options.breaks else None, how_far)
        ended = follower.to_the_end()
    finally:
        handle.close()
    if follower.lost:
        echo_error(f"tuisim: {follower.lost} (run {handle.number} contains every line)")
    ended_code = exit_status.EXIT_LIMIT if teller.stopped else exit_status.exit_code_of(ended)
    code = interrupts.exit_code or follower.cut or ended_code
    return max(code, exit_status.EXIT_BAD_OUTPUT) if follower.lost or handle.unstored else code, handle
