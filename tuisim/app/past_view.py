"""Shows a past instant in the panels that show more than one moment: trace, output, markers of the time bar."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tuisim.app.feed import trace_until

if TYPE_CHECKING:
    from tuisim.app.panel_area import PanelArea
    from tuisim.app.timeline import Timeline

PAST_ROWS = 200
"""Number of output rows shown of a past instant."""


class Lookback:
    """Keeps panels at the instant in view.

    Args:
        desk: The panel area.
        timeline: Provides that instant.
    """

    def __init__(self, desk: PanelArea, timeline: Timeline) -> None:
        self._panel_area = desk
        self._timeline = timeline
        self._traced: object = None
        self._printed: object = None

    def show(self) -> None:
        """Update the panels if they show another instant."""
        desk, timeline = self._panel_area, self._timeline
        recording, tick = timeline.recording, timeline.at
        if world := desk.world:
            world.time_bar.marks = timeline.marks
            key = None if tick is None or recording is None else (recording, tick, world)
            if key != self._traced:
                self._traced = key
                if tick is None or recording is None:
                    world.show_past_trace(None)
                else:
                    world.show_past_trace(trace_until(recording, tick), recording.spec.robot.pen)
        if output := desk.output:
            count = None if tick is None or recording is None else (recording, recording.rows.until(tick), output)
            if count != self._printed:
                self._printed = count
                if tick is None or recording is None:
                    output.look_back(None)
                else:
                    output.look_back(*recording.rows.texts_until(tick, PAST_ROWS))
