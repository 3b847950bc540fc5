"""Keys of the group Panes: which pane is shown, what its events are, and the world beside the log."""

from __future__ import annotations

from tuisim.analysis.events import Event, Threshold, events_of, thresholds_of
from tuisim.app.analyser.screen import LogScreen
from tuisim.app.analyser.world import NO_POSES, has_poses
from tuisim.logs.log import Log

_FORMS = (
    ("Colour < 50", "where it falls below 50"),
    ("Colour > 50", "where it rises above 50"),
    ("Colour = 50", "both"),
    ("Colour = 50 +- 5", "only if it goes 5 beyond on either side"),
    ("Colour < 50, Left > 3", "several"),
    ("(nothing)", "none"),
)


def show(screen: LogScreen, pane: str) -> None:
    """Show a pane."""
    screen.show_pane(pane)


def events(screen: LogScreen) -> None:
    """Show the events; ask for thresholds if there are none, or if the events are shown already."""
    model = screen.model
    shown = screen.pane.name_shown == "events" and screen.pane.display
    screen.show_pane("events")
    if (shown or not model.events.thresholds) and model.log.rows:
        now = ", ".join(map(str, model.events.thresholds))
        screen.ask("Events", lambda text: _search(screen, text), now, _FORMS, completes=True)


def _search(screen: LogScreen, text: str) -> None:
    log = screen.model.log
    thresholds = thresholds_of(text, log)

    def found(result: tuple[Log, tuple[Threshold, ...], list[Event]]) -> None:
        # The log may have grown meanwhile: search again.
        screen.model.events.take(*result)
        screen.choose(0)
        screen.update()

    screen.work("searching for events …", log.rows, lambda _: (log, thresholds, events_of(log, thresholds)), found)


def larger(screen: LogScreen) -> None:
    """Cycle through chart and pane, chart alone, pane alone."""
    both = screen.chart.display and screen.pane.display
    screen.lay_out(chart=both or not screen.chart.display, pane=not both)


def world(screen: LogScreen) -> None:
    """Show or hide the world beside the log."""
    pane = screen.world
    if not has_poses(screen.model.subject):
        screen.say(NO_POSES)
        return
    pane.display = pane.is_on = not pane.display
    screen.call_after_refresh(screen.update)
