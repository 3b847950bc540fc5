"""The state of an analysis: the cursor, the selection, derived variables and notes."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tuisim.analysis.events import Events
from tuisim.analysis.source import Note, OpenedLog, read_notes, write_notes
from tuisim.analysis.traces import DISTANCE, TIME, LogTrace, LogTraces, align_series
from tuisim.base.errors import LogError, among
from tuisim.engine.runs.arrays import FloatArray
from tuisim.logs.bands import Band, BandReport, build_band_report
from tuisim.logs.derived import (
    RECKONED_COLUMNS,
    build_reckoned_series,
    find_named_columns,
    parse_definition,
)
from tuisim.logs.plateaus import Search, find_plateaus
from tuisim.logs.signals import Summary, compute_summary
from tuisim.logs.table import Rows
from tuisim.logs.units import drop_run
from tuisim.pictures.charts.axes import Limits

if TYPE_CHECKING:
    from tuisim.logs.log import Log

_MIN_SHOWN_SHARE = 1e-9
"""Smallest time range that zooming in can show, as a fraction of the whole time of the log."""
_SORTED_AT_ONCE = 200_000
"""Maximum number of values in a span for which quantiles are computed, which takes some hundredths of a second."""


class AnalysisModel:
    """The state of the analysis of one log: its variables, cursors, visible range, bands and notes.

    Raises:
        LogError: the log has rows but no numeric column, or its notes cannot be read.
    """

    def __init__(self, opened: OpenedLog) -> None:
        self.opened = opened
        self.log = opened.log
        self.rows = Rows(opened.log)
        self.traces = LogTraces(opened.log)
        ticked = self.traces.list_ticked()
        if self.log.rows and not ticked:
            raise LogError("no numeric column", "there is nothing to draw", file=self.log.title)
        self.selected: str = ticked[0].name if ticked else ""
        """Name of the selected variable, from sample to sample of which keys move the cursor; empty for none."""
        self.row: int = 0
        """Index of the table's row at which the cursor is; all panes show it."""
        self.mark_s: float | None = None
        """Time of the chart's second cursor, named A; None if it is not set."""
        self.limits: Limits | None = None
        """Time range in s that the chart shows; None for the whole time."""
        self.alignment = TIME
        self._reports: dict[str, BandReport] = {}
        self._reported: tuple[list[BandReport], list[Band]] = ([], [])
        """The latest band reports, and all their bands in one list, so that the list is built only once."""
        self.events = Events(opened.runs)
        self.definitions: dict[str, str] = {}
        """Definitions of derived variables, as the user typed them, by the name of the variable."""
        self._words: dict[str, str] = {}
        self._summaries: dict[str, Summary] = {}
        self._places = opened.find_notes_files()
        self._notes: list[list[Note]] = [list(read_notes(place)) for place in self._places]
        if ticked and len(self.trace.series.rows):
            self.row = int(self.trace.series.rows[0])

    # The cursor

    @property
    def x_unit(self) -> str:
        """The unit of the horizontal axis."""
        return "mm" if self.alignment == DISTANCE else "s"

    @property
    def trace(self) -> LogTrace:
        """The trace of the selected variable."""
        return self.traces.find_trace(self.selected)

    def trace_of_row(self, row: int) -> LogTrace:
        """Return the variable to which a row of the log belongs; the selected one if the row names none."""
        layout = self.log.layout
        table = self.log.table
        if not layout.variable:
            name = drop_run(self.selected) if layout.run else self.selected
        else:
            name = str(table.column(layout.variable)[row].as_py())
        if (
            layout.run
            and (key := f"{name} #{table.column(layout.run)[row].as_py()}") in self.traces
        ):
            name = key
        # A row may have no name or no run: it then belongs to the selected variable.
        return self.traces.find_trace(name if name in self.traces else self.selected)

    @property
    def cursor_s(self) -> float:
        """The position of the cursor on the x axis: the time of its row in s, or the distance driven.

        It is the distance, in mm, if runs are aligned by distance.
        """
        trace = self.trace_of_row(self.row)
        return float(trace.places[self._sample(trace, self.row)])

    def find_place(self, row: int, time_s: float) -> float:
        """Return the position on the x axis for a time of a run.

        Args:
            row: A row of the log that belongs to the run.
            time_s: The time in the run.
        """
        if self.alignment == TIME:
            return time_s
        trace = self.trace_of_row(row)
        sample = self._sample(trace, row)
        return time_s + float(trace.places[sample] - trace.series.time_s[sample])

    def find_time_s(self, row: int) -> float:
        """Return the time of a row in its run, in s."""
        trace = self.trace_of_row(row)
        return float(trace.series.time_s[self._sample(trace, row)])

    @staticmethod
    def _sample(trace: LogTrace, row: int) -> int:
        """Return the index of a variable's sample in a row of the log.

        If the variable has no sample there, return the index of its next sample, or else of its last one.
        """
        rows = trace.series.rows
        return min(int(np.searchsorted(rows, row)), len(rows) - 1)

    @property
    def sample(self) -> int:
        """The index of the selected variable's sample in the row of the cursor.

        If the variable has no sample there, it is the index of its next sample, or else of its last one.
        """
        return self._sample(self.trace, self.row)

    def sample_variable(self, name: str) -> FloatArray:
        """Return the values of a variable or column at each sample of the selected variable, shape (n,).

        Raises:
            LogError: there is no variable or column of that name, or it is not numeric.
        """
        series = self.trace.series
        if name in self.traces:
            other = self.traces.find_trace(name).series
            if other is series:
                return other.values
            return other.sample(series.time_s)
        if name not in (numbers := self.log.numeric_columns):
            known = dict.fromkeys((*self.log.names, *numbers))
            raise LogError(f"no variable {name!r}", among(name, known), file=self.log.title)
        return self.log.numbers(name)[series.rows]

    def find_run(self, row: int) -> int:
        """Return the index of the run to which a row belongs, from 0."""
        return max(0, self.trace_of_row(row).series.run - 1)

    def find_printed_line(self) -> int:
        """Return the line of the program that printed the row of the cursor; 0 if the log does not say."""
        if "line" not in self.log.table.column_names:
            return 0
        return int(self.log.table.column("line")[self.row].as_py() or 0)

    def go_to_time(self, time_s: float) -> None:
        """Move the cursor to the selected variable's sample nearest to a position on the x axis."""
        if len(self.trace.pyramid.times_s):
            self.row = int(self.trace.series.rows[self.trace.pyramid.find_nearest(time_s)])

    def go_to_moment(self, time_s: float) -> None:
        """Move the cursor to the selected variable's sample nearest to a time of the variable's run, in s."""
        series = self.trace.series
        if len(series.rows):
            self.row = int(series.rows[int(np.nanargmin(np.abs(series.time_s - time_s)))])

    def step(self, samples: int) -> None:
        """Move the cursor by a number of samples of the selected variable; a negative number moves it back."""
        rows = self.trace.series.rows
        if len(rows):
            # The row may be one of another variable, between two samples.
            index = (
                int(np.searchsorted(rows, self.row, "right" if samples > 0 else "left"))
                + samples
                - (samples > 0)
            )
            self.row = int(rows[min(max(index, 0), len(rows) - 1)])

    def restore(self, other: AnalysisModel) -> None:
        """Copy cursors, selection and settings of another model, which was made when the same log was shorter."""
        self.row = other.row
        self.mark_s = other.mark_s
        self.limits = other.limits
        if other.row == other.log.rows - 1:
            # The cursor stays at the end of a growing log.
            self.row = self.log.rows - 1
        self.copy_definitions(other)
        for trace in other.traces:
            if trace.name in self.traces:
                self.traces.find_trace(trace.name).on = trace.on
        if other.selected in self.traces:
            self.selected = other.selected
        self.events.thresholds = other.events.thresholds
        self.rows.restore(other.rows)
        if other.alignment != TIME:
            self._align_again(other.alignment)

    def copy_definitions(self, other: AnalysisModel) -> None:
        """Compute the derived variables that another model of the same log has.

        This is slow for a long log: call it in a thread.
        """
        for name, text in other.definitions.items():
            if name not in self.definitions:
                # Definitions that need variables which no longer exist are dropped.
                with suppress(LogError):
                    self.derive(text)

    def set_log(self, log: Log) -> None:
        """Replace the log by the same log with other derived variables."""
        self.log, self.opened = log, replace(self.opened, log=log)
        before = {trace.name: trace for trace in self.traces}
        self.traces.set_log(log)
        self.rows.set_log(log)
        for name, trace in before.items():
            if name not in self.traces or self.traces.find_trace(name) is not trace:
                self._reports.pop(name, None)
                self._summaries.pop(name, None)
        if self.selected not in self.traces:
            self.selected = next(iter(self.traces)).name
        if self.alignment != TIME:
            self._align_again(self.alignment)

    def _align_again(self, way: str) -> None:
        limits = self.limits
        mark_s = self.mark_s
        self.align(way)
        self.limits = limits
        self.mark_s = mark_s

    def go_to_row(self, row: int) -> None:
        """Move the cursor to a row; if the log has no such row, move it to the first or the last row."""
        self.row = min(max(row, 0), max(self.log.rows - 1, 0))

    def select(self, step: int) -> None:
        """Move the selection down by a number of variables; after the last variable comes the first."""
        names = [trace.name for trace in self.traces]
        if names:
            self.selected = names[(names.index(self.selected) + step) % len(names)]

    def add_named_columns(self, text: str) -> None:
        """Derive the columns of the recording that a text names and the log lacks, if they can be computed."""
        for name in find_named_columns(self.log, text):
            self.derive(name)

    def align(self, way: str) -> None:
        """Align the runs of the log on the x axis.

        Args:
            way: `time`; `distance`, how far each robot has driven; or an event such as `Colour < 50`.

        Raises:
            LogError: the log does not say how far the robot drove, or no run has such an event.
        """
        self.add_named_columns(way)
        places_of_all = align_series(self.log, [trace.series for trace in self.traces], way)
        for trace, places in zip(self.traces, places_of_all, strict=True):
            trace.align(places)
        self.alignment = way
        self.limits = None
        self.mark_s = None

    # The following methods move the visible range of the chart.

    def find_x_limits(self) -> Limits:
        """Return the visible range of the x axis."""
        return self.limits or self.traces.find_span_s()

    def zoom(self, factor: float) -> None:
        """Multiply the width of the visible range of the x axis by a factor; the cursor stays in place."""
        (low, high), (first, last) = self.find_x_limits(), self.traces.find_span_s()
        width = max((high - low) * factor, (last - first) * _MIN_SHOWN_SHARE)
        if width >= last - first:
            self.limits = None
            return
        share = (min(max(self.cursor_s, low), high) - low) / (high - low)
        self._move_limits(self.cursor_s - share * width, width)

    def pan(self, share: float) -> None:
        """Move the visible range of the x axis by a share of its width; a negative share moves it to smaller values."""
        low, high = self.find_x_limits()
        if self.limits:
            self._move_limits(low + share * (high - low), high - low)

    def _move_limits(self, low: float, width: float) -> None:
        first, last = self.traces.find_span_s()
        low = min(max(low, first), last - width)
        self.limits = low, low + width

    def follow_cursor(self) -> None:
        """If the cursor is outside the visible range of the x axis, move that range to the cursor."""
        if self.limits and not self.limits[0] <= self.cursor_s <= self.limits[1]:
            width = self.limits[1] - self.limits[0]
            self._move_limits(self.cursor_s - width / 2, width)

    # Bands

    def list_unsearched(self) -> list[str]:
        """Return the names of the visible variables in which bands have not been searched for yet."""
        return [
            trace.name for trace in self.traces.list_ticked() if trace.name not in self._reports
        ]

    def find_bands(self, names: Sequence[str], search: Search = find_plateaus) -> None:
        """Search variables for bands.

        This is slow for a long log: call it in a thread, with a search in another process.
        """
        for name in names:
            report = build_band_report(self.log, name, search)
            self._words[name] = report.describe()
            self._reports[name] = report

    def list_reports(self) -> list[BandReport]:
        """Return the reports on the bands of the visible variables, one for each variable."""
        return [
            self._reports[trace.name]
            for trace in self.traces.list_ticked()
            if trace.name in self._reports
        ]

    def describe_bands(self) -> list[str]:
        """Return a sentence about the bands of each visible variable."""
        return [self._words[report.variable] for report in self.list_reports()]

    def bands(self) -> Sequence[Band]:
        """Return the bands of the visible variables, without variables in which bands were not searched for yet."""
        reports = self.list_reports()
        if reports != self._reported[0]:
            self._reported = reports, [band for report in reports for band in report.bands]
        return self._reported[1]

    def find_measured_span(self) -> Limits | None:
        """Return the range between the two cursors on the x axis; None if the second cursor, A, is not set."""
        if self.mark_s is None or not self.log.rows:
            return None
        return min(self.mark_s, self.cursor_s), max(self.mark_s, self.cursor_s)

    def list_unsummed(self) -> list[str]:
        """Return the names of the visible variables whose statistics are not computed yet.

        With two cursors, the list is empty: the statistics between them take no time.
        """
        if self.find_measured_span() is not None:
            return []
        return [
            trace.name for trace in self.traces.list_ticked() if trace.name not in self._summaries
        ]

    def sum_up(self, names: Sequence[str]) -> None:
        """Compute the statistics of variables over all samples.

        This is slow for a long log: call it in a thread.
        """
        for name in names:
            self._summaries[name] = compute_summary(self.traces.find_trace(name).series.values)

    def build_summary(self, name: str) -> Summary:
        """Return the statistics of a variable between the two cursors; without the second cursor, over all samples.

        The statistics over all samples are computed only once.
        """
        span = self.find_measured_span()
        if span is not None:
            pyramid = self.traces.find_trace(name).pyramid
            values = pyramid.select_range(*span)[1]
            # Quantiles of many values would slow down the cursor.
            return (
                compute_summary(values)
                if len(values) <= _SORTED_AT_ONCE
                else pyramid.compute_summary(*span)
            )
        if name not in self._summaries:
            self.sum_up([name])
        return self._summaries[name]

    # Notes

    @property
    def notes(self) -> list[tuple[int, Note]]:
        """Every note on the log, with the index of its run, in order of time."""
        return [(run, note) for run, notes in enumerate(self._notes) for note in notes]

    def add_note(self, text: str, start_s: float, stop_s: float, variable: str, run: int) -> None:
        """Add a note on a run, and write it to the file with the notes.

        Args:
            text: The text of the note.
            start_s, stop_s: The time range of the run that the note is about, in s.
            variable: The name of the variable that the note is about.
            run: Index of the run in the log, from 0.

        Raises:
            LogError: the note cannot be written, or the log is the standard input.
        """
        place = self._place(run)
        notes = [*self._notes[run]]
        note = Note(text, start_s, stop_s, variable)
        notes.insert(bisect_right(notes, start_s, key=lambda other: other.start_s), note)
        write_notes(place, notes)
        self._notes[run] = notes

    def drop_note(self, run: int, note: Note) -> None:
        """Delete a note on a run.

        Args:
            run: Index of the run in the log, from 0.
            note: The note.

        Raises:
            LogError: the file with the other notes cannot be written.
        """
        notes = [other for other in self._notes[run] if other is not note]
        write_notes(self._place(run), notes)
        self._notes[run] = notes

    def _place(self, run: int) -> Path:
        if run >= len(self._places):
            raise LogError("notes cannot be stored", "open a file or a run instead of a pipe")
        return self._places[run]

    def apply_definition(self, text: str, log: Log) -> None:
        """Apply a definition of a derived variable, with the log that `compute_definition` returned for it."""
        name = RECKONING if text == RECKONING else parse_definition(text).name
        self.definitions.pop(name, None)
        if text == RECKONING or parse_definition(text).expression:
            self.definitions[name] = text
        self.set_log(log)
        derived_name = RECKONED_COLUMNS[-1] if name == RECKONING else name
        self.selected = next(
            (variable for variable in log.derived if drop_run(variable) == derived_name),
            self.selected,
        )

    def compute_definition(self, text: str) -> tuple[str, Log]:
        """Return the stripped text of a definition, and the log with its derived variable.

        A definition without an expression removes the variable from the log.

        Raises:
            LogError: the line is invalid, or names an unknown variable.
        """
        text = text.strip()
        log = self.log
        if text == RECKONING:
            for series in build_reckoned_series(log):
                log = log.add_derived(series.name, [series])
            return text, log
        definition = parse_definition(text)
        bare = log.drop_derived(definition.name)
        if definition.expression:
            return text, bare.add_derived(definition.name, definition.compute(bare, self.selected))
        if bare is log:
            names = dict.fromkeys(drop_run(name) for name in log.derived)
            raise LogError(
                f"no derived variable {definition.name!r}",
                f"there are {', '.join(names) or 'none'}",
            )
        return text, bare

    def derive(self, text: str) -> None:
        """Compute the derived variable of a definition, and add it to the log; block until this is done.

        Raises:
            LogError: the line is invalid, or names an unknown variable.
        """
        self.apply_definition(*self.compute_definition(text))


RECKONING = "reckoning"
"""What the user types instead of a definition, to derive the robot's path from the wheel encoders."""
