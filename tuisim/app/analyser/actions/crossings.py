"""Functions behind the keys for events: set thresholds, and go to the next or previous crossing."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tuisim.analysis.events import Event, Threshold, events_of, thresholds_of
from tuisim.app.analyser.actions.derive import words
from tuisim.app.analyser.background import work
from tuisim.app.analyser.prompt import LinePrompt

if TYPE_CHECKING:
    from tuisim.app.analyser.screen import Analyser
    from tuisim.logs.log import Log

_FORMS = (
    ("Colour < 50", "where it falls below 50"),
    ("Colour > 50", "where it rises above 50"),
    ("Colour = 50", "both"),
    ("Colour = 50 +- 5", "only if it goes 5 beyond on either side"),
    ("Colour < 50, Left > 3", "several"),
    ("(nothing)", "none"),
)


def show(screen: Analyser) -> None:
    """Show the events; ask for thresholds if there are none, or if the events are shown already."""
    model = screen.model
    if model is None:
        return
    shown = screen.pane.name_shown == "events" and screen.pane.display
    screen.pane.turn_to("events")
    if not screen.pane.display:
        screen.lay_out(chart=True, pane=True)
    screen.update()
    if (shown or not model.events.thresholds) and model.log.rows:
        ask(screen)


def ask(screen: Analyser) -> None:
    """Ask for thresholds."""
    model = screen.model
    if model is None:
        return

    def go(text: str) -> None:
        log = screen.at_hand().log
        thresholds = thresholds_of(text, log)
        work(
            screen,
            "searching for events …",
            log.rows,
            lambda _: (log, thresholds, events_of(log, thresholds)),
            found,
        )

    def found(those: tuple[Log, tuple[Threshold, ...], list[Event]]) -> None:
        # The log may have grown meanwhile: search again.
        screen.at_hand().events.take(*those)
        screen.choose(0)
        screen.update()

    now = ", ".join(map(str, model.events.thresholds))
    screen.app.push_screen(LinePrompt("Events", go, now, _FORMS, tuple(words(model.log))))


def jump(screen: Analyser, step: int) -> None:
    """Go to the next event, or the previous one."""
    model = screen.model
    if model is None:
        return
    events = model.events.found(model.log)
    if not events:
        screen.say("No events: c asks for a threshold, such as Colour < 50")
        return
    rows = [event.row for event in events]
    ahead = [at for at, row in enumerate(rows) if (row > model.row if step > 0 else row < model.row)]
    if not ahead:
        screen.say("That was the last event" if step > 0 else "That was the first event")
        return
    go_to(screen, ahead[0] if step > 0 else ahead[-1])
    screen.update()


def go_to(screen: Analyser, number: int) -> None:
    """Put the cursor on an event."""
    model = screen.model
    if model is None:
        return
    event = model.events.found(model.log)[number]
    model.selected = event.variable
    model.go_to_row(event.row)
    model.follow_cursor()
    if screen.pane.name_shown == "events":
        screen.pane.chosen = number
