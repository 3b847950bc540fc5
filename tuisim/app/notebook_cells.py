"""What the cells of a notebook ask of the app that is shown in one of them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tuisim.app.actions import robot
from tuisim.app.actions.files import open_brought
from tuisim.base.errors import TuisimError
from tuisim.base.source import Program
from tuisim.engine.runs.handle import RunOptions
from tuisim.programs.program_file import ProgramSource

if TYPE_CHECKING:
    from tuisim.app.actions import ActionContext

BUSY = "the app runs a program: S in it, or its button Stop, stops that"


def do_asked(context: ActionContext, asked: Mapping[str, Any]) -> None:
    """Do what the web server that shows the app in a browser requests.

    Args:
        context: The parts of the app.
        asked: The request. Its entry `what` says what to do: `open` opens the file with the path `path`; `stop` stops
            the program; `run` shows the stored run with the id `id`; `cell` applies the `settings` and the `program` of
            a notebook's cell. The request for a cell also says whether the robot goes back to its start pose (`home`),
            whether the program is started (`runs`), and at which `speed`, where None leaves the choice to the app.
    """
    match asked:
        case {"what": "open", "path": str(path)}:
            open_brought(context, Path(path))
        case {
            "what": "cell",
            "settings": dict(settings),
            "program": program,
            "home": bool(home),
            "runs": bool(runs),
            "speed": speed,
        }:
            options = _choose_run_options(context, speed) if runs else None
            _take_cell(context, settings, program, home=home, options=options)
        case {"what": "stop"}:
            context.runs.stop()
        case {"what": "run", "id": str(run_id)}:
            context.loader.open_run(run_id)


def _take_cell(
    context: ActionContext,
    settings: Mapping[str, Any],
    program: Mapping[str, Any] | None,
    *,
    home: bool,
    options: RunOptions | None,
) -> None:
    if context.runs.in_run:
        context.app.tell_server("problem", text=BUSY)
        return
    try:
        # JSON has no tuples, so they arrive as lists.
        choices = {
            path: tuple(value) if isinstance(value, list) else value
            for path, value in settings.items()
        }
        context.loader.take_cell(
            ProgramSource(Program(**program), choices, has_magic=True) if program else None, choices
        )
    except TuisimError as error:
        context.app.complain(error)
        return
    if home:
        robot.home(context)
    if options is not None:
        context.runs.next_options = options
        context.app.start_run()


def _choose_run_options(context: ActionContext, speed: float | None) -> RunOptions:
    """Return the options of a cell's run: its speed, and the same limits as for a cell without the app.

    The speed is that of the cell or, if the cell has none, that which the user has chosen in the app. If there is no
    such choice either, the run is as fast as possible.
    """
    runs = context.runs
    if speed:
        runs.speed = speed
    rushes = not (speed or (speed is None and runs.has_chosen_speed))
    return RunOptions(
        live=True, speed=0.0 if rushes else runs.speed, asks_user=True, time_waits=rushes
    )
