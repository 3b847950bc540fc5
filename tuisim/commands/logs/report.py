"""`tuisim log report`: writes a one-page report on a run or a log."""

from __future__ import annotations

from argparse import Namespace
from pathlib import Path

from tuisim.analysis.source import LogRequest, opening
from tuisim.commands.analyse import asked
from tuisim.commands.echo import echo
from tuisim.commands.logs.sources import names_of
from tuisim.errors import ConfigError
from tuisim.report.report import check_report, default_name, write_report


def report(arguments: Namespace) -> int:
    """Write the report and print its path.

    Raises:
        ConfigError: no log, or a file together with another log.
        LogError: the log cannot be read, or there is no such variable.
        ExportError: the file cannot be written.
    """
    if arguments.json:
        raise ConfigError("does not take --json", "`tuisim log summary` and `bands` do", key="report")
    if not arguments.words:
        raise ConfigError("which log?", "a file, `-`, or a stored run such as `last`", key="report")
    if arguments.out:
        check_report(Path(arguments.out))
    what = asked(arguments)
    if arguments.telemetry and len(what.runs) > 1:
        raise ConfigError("takes one run", f"got {len(what.runs)}", key="--telemetry")
    if what.runs and (arguments.time is not None or arguments.value):
        raise ConfigError("are for files only", "the columns of a run are fixed", key="--time and --value")
    wanted = LogRequest(
        what.file, what.runs, arguments.telemetry, arguments.time, tuple(arguments.value), arguments.unit
    )
    *_, subject = opening(wanted)
    names = names_of(subject.log, arguments) if arguments.variable else ()
    target = Path(arguments.out or default_name(subject))
    write_report(subject, target, names)
    echo(str(target))
    return 0
