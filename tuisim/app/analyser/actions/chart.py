"""Keys of the group Chart: its variables, its time range, its options, and the second cursor."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tuisim.analysis.traces import TIME
from tuisim.app.analyser.chart import FACETS_ROWS
from tuisim.base.errors import LogError

if TYPE_CHECKING:
    from tuisim.app.analyser.screen import LogScreen

_ALIGNMENTS = (
    ("time", "the start of each run"),
    ("distance", "the distance driven"),
    ("Colour < 50", "the first time at which each run meets the condition"),
)
_AGAINST = (
    ("y_mm against x_mm", "the path of the robot"),
    ("Ultrasonic", "the selected variable against another one"),
    ("(nothing)", "every variable over time"),
)


def mark(screen: LogScreen) -> None:
    """Put the second cursor where the first one is; if there is a second cursor already, remove it."""
    screen.model.mark_s = screen.model.cursor_s if screen.model.mark_s is None else None


def pan_chart(screen: LogScreen, share: float) -> None:
    """Move the time range of the chart by a share of its length; a negative share moves it to earlier times."""
    screen.model.pan(share)


def fit(screen: LogScreen) -> None:
    """Show the whole time range of the log in the chart."""
    screen.model.limits = None


def tick(screen: LogScreen) -> None:
    """Draw the selected variable in the chart; if it is drawn already, remove it from the chart."""
    if screen.model.selected:
        screen.model.trace.on = not screen.model.trace.on


def switch_facets(screen: LogScreen) -> None:
    """Switch between one chart for each variable and one chart for all."""
    switch(screen, "facets")
    if screen.chart.options.facets:
        if len(screen.model.traces.list_ticked()) < 2:
            screen.say(
                "Only one variable is shown. Press v to select another, then space to show it."
            )
        elif screen.chart.display and screen.chart.size.height < FACETS_ROWS:
            screen.say("Too little height for several charts: + enlarges the chart")


def switch(screen: LogScreen, option: str) -> None:
    """Turn an option of the chart on, or off if it is on.

    Args:
        screen: The analyser.
        option: Name of a field of `ChartOptions` that is True or False.
    """
    options = screen.chart.options
    setattr(options, option, not getattr(options, option))
    screen.redraw_chart()


def align(screen: LogScreen) -> None:
    """Ask by what to align the runs in the chart, such as time or distance, and draw the chart again."""

    def go(text: str) -> None:
        screen.model.align(text or TIME)
        screen.redraw_chart()

    screen.ask("Align runs by", go, screen.model.alignment, _ALIGNMENTS)


def ask_axes(screen: LogScreen) -> None:
    """Ask which two variables to draw against each other; an empty answer draws all variables over time again."""
    options = screen.chart.options

    def go(text: str) -> None:
        model = screen.model
        names = [name.strip() for name in text.split(" against ")]
        if not text:
            options.against = None
        else:
            if len(names) > 2:
                raise LogError(
                    f"cannot draw {text!r}", "a name, or two with `against` between them"
                )
            y, x = names if len(names) == 2 else (model.selected, names[0])
            for name in (x, y):
                model.sample_variable(name)
            options.against = x, y
        screen.redraw_chart()

    now = f"{options.against[1]} against {options.against[0]}" if options.against else ""
    screen.ask("Draw", go, now, _AGAINST)
