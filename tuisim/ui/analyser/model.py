"""The state of the analyser: one cursor in time, what is chosen, and the notes. No Textual here."""

from __future__ import annotations

from bisect import bisect_right
from typing import TYPE_CHECKING

import numpy as np

from tuisim.datalog.analysis.logbands import Band, BandReport, band_report
from tuisim.datalog.notes import Note, read_notes, write_notes
from tuisim.errors import LogError
from tuisim.ui.analyser.rows import Rows
from tuisim.ui.analyser.traces import LogTrace, LogTraces
from tuisim.ui.render.axes import Limits

if TYPE_CHECKING:
    from pathlib import Path

    from tuisim.ui.analyser.subject import Subject

_LEAST_SPAN = 1e-9
"""Of the whole time: the chart zooms in no further."""


class Model:
    """One log as it is looked at.

    Args:
        subject: The log.

    Raises:
        LogError: its notes cannot be read.
    """

    def __init__(self, subject: Subject) -> None:
        self.subject = subject
        self.log = subject.log
        self.rows = Rows(subject.log)
        self.traces = LogTraces(subject.log)
        names = subject.log.names
        self.selected: str = names[0] if names else ""
        """Variable whose samples the cursor goes along."""
        self.row: int = 0
        """Row of the table that everything shows."""
        self.mark_s: float | None = None
        """The other cursor of the chart."""
        self.limits: Limits | None = None
        """Times that the chart shows, None for all."""
        self._reports: dict[str, BandReport] = {}
        self._places = subject.notes_places()
        self._notes: list[list[Note]] = [list(read_notes(place)) for place in self._places]
        if names and len(self.trace.series.rows):
            self.row = int(self.trace.series.rows[0])

    # The cursor

    @property
    def trace(self) -> LogTrace:
        """The selected variable."""
        return self.traces.named(self.selected)

    def trace_of_row(self, row: int) -> LogTrace:
        """Return the trace that a row belongs to."""
        layout, table = self.log.layout, self.log.table
        if not layout.variable:
            name = self.selected.partition(" #")[0] if layout.run else self.selected
        else:
            name = str(table.column(layout.variable)[row].as_py())
        if layout.run and (key := f"{name} #{table.column(layout.run)[row].as_py()}") in self.traces:
            name = key
        return self.traces.named(name)

    @property
    def cursor_s(self) -> float:
        """Time of the row that is looked at, as the chart counts it."""
        return self.time_of(self.row) + self.trace_of_row(self.row).shift_s

    def time_of(self, row: int) -> float:
        """Return the time of a row in its run."""
        series = self.trace_of_row(row).series
        return float(series.time_s[min(int(np.searchsorted(series.rows, row)), len(series.rows) - 1)])

    def run_of(self, row: int) -> int:
        """Return which run a row is of, from 0."""
        return max(0, self.trace_of_row(row).series.run - 1)

    def printed_line(self) -> int:
        """Return the line of the program that printed the row, 0 if the log does not say."""
        if "line" not in self.log.table.column_names:
            return 0
        return int(self.log.table.column("line")[self.row].as_py() or 0)

    def go_to_time(self, time_s: float) -> None:
        """Go to the sample of the selected variable that is nearest to a time of the chart."""
        series, shift_s = self.trace.series, self.trace.shift_s
        if len(series.time_s):
            self.row = int(series.rows[int(np.nanargmin(np.abs(series.time_s + (shift_s - time_s))))])

    def step(self, samples: int) -> None:
        """Go to a sample of the selected variable before or after the one that is looked at."""
        rows = self.trace.series.rows
        if len(rows):
            at = int(np.searchsorted(rows, self.row)) + samples
            self.row = int(rows[min(max(at, 0), len(rows) - 1)])

    def take_over(self, other: Model) -> None:
        """Go on where one was in the same log, of which there is more now."""
        self.row, self.mark_s, self.limits = other.row, other.mark_s, other.limits
        if other.selected in self.traces:
            self.selected = other.selected
        for trace in other.traces:
            if trace.name in self.traces:
                self.traces.named(trace.name).on = trace.on
        self.rows.take_over(other.rows)

    def go_to_row(self, row: int) -> None:
        """Go to a row of the table, the nearest there is."""
        self.row = min(max(row, 0), max(self.log.rows - 1, 0))

    def select(self, step: int) -> None:
        """Choose another variable."""
        names = [trace.name for trace in self.traces]
        if names:
            self.selected = names[(names.index(self.selected) + step) % len(names)]

    # The part of the time that the chart shows

    def x_limits(self) -> Limits:
        """Return the times at the chart's edges."""
        return self.limits or self.traces.span_s()

    def zoom(self, factor: float) -> None:
        """Show more or less time around the cursor."""
        (low, high), (first, last) = self.x_limits(), self.traces.span_s()
        width = max((high - low) * factor, (last - first) * _LEAST_SPAN)
        if width >= last - first:
            self.limits = None
            return
        share = (min(max(self.cursor_s, low), high) - low) / (high - low)
        self._show_from(self.cursor_s - share * width, width)

    def pan(self, share: float) -> None:
        """Move what is shown by a part of its width."""
        low, high = self.x_limits()
        if self.limits:
            self._show_from(low + share * (high - low), high - low)

    def _show_from(self, low: float, width: float) -> None:
        first, last = self.traces.span_s()
        low = min(max(low, first), last - width)
        self.limits = low, low + width

    def follow_cursor(self) -> None:
        """Bring the cursor into what the chart shows."""
        if self.limits and not self.limits[0] <= self.cursor_s <= self.limits[1]:
            width = self.limits[1] - self.limits[0]
            self._show_from(self.cursor_s - width / 2, width)

    # Bands

    def report(self, name: str) -> BandReport:
        """Return the bands of a variable, found once."""
        if name not in self._reports:
            self._reports[name] = band_report(self.log, name)
        return self._reports[name]

    def bands(self) -> list[Band]:
        """Return the bands of the ticked variables."""
        return [band for trace in self.traces.ticked() for band in self.report(trace.name).bands]

    # Notes

    @property
    def notes(self) -> list[tuple[int, Note]]:
        """Every note with the number of its run, from 0, in order of time."""
        return [(run, note) for run, notes in enumerate(self._notes) for note in notes]

    def add_note(self, text: str, start_s: float, stop_s: float, variable: str, run: int) -> None:
        """Write a note to its run's file.

        Raises:
            LogError: it cannot be written, or the log is none that can be found again.
        """
        place = self._place(run)
        notes = [*self._notes[run]]
        note = Note(text, start_s, stop_s, variable)
        notes.insert(bisect_right(notes, start_s, key=lambda other: other.start_s), note)
        write_notes(place, notes)
        self._notes[run] = notes

    def drop_note(self, run: int, note: Note) -> None:
        """Delete a note.

        Raises:
            LogError: the others cannot be written.
        """
        notes = [other for other in self._notes[run] if other is not note]
        write_notes(self._place(run), notes)
        self._notes[run] = notes

    def _place(self, run: int) -> Path:
        if run >= len(self._places):
            raise LogError("notes cannot be kept", "only with a file or a run, not what comes from a pipe")
        return self._places[run]
