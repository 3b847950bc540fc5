"""What has come from a run since the app looked last."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from tuisim.app.branch import Branch
from tuisim.app.snapshot import describe_busy_loop
from tuisim.base.data_class import dataclass
from tuisim.engine import protocol
from tuisim.engine.core.spec import RunSpec
from tuisim.engine.runs.contacts import LEFT_FIELD, find_push, find_standstill, has_left_field
from tuisim.engine.runs.records import OutputRow
from tuisim.engine.runs.samples import describe_near_sample
from tuisim.engine.runs.views import TelemetryView
from tuisim.programs.plugged_words import describe_newest

if TYPE_CHECKING:
    from tuisim.engine.runs.recorded_run import Recording


@dataclass(frozen=True, slots=True)
class RunUpdate:
    """The output and the events that the run has sent since the last poll."""

    rows: list[OutputRow]
    ended: protocol.Ended | None = None
    """The end of the run, in the poll that receives it; else None."""
    stood: str = ""
    """The words of `describe_contacts`, in the same poll; may be empty."""
    spoken: tuple[protocol.Spoke, ...] = ()
    """Texts and sounds from the program."""
    prompt: str | None = None
    """The prompt while the program waits in `input()`."""
    branched: Branch | None = None
    """The branch that has just reached its instant, or has ended before it; else None."""
    pauses: tuple[protocol.Message, ...] = ()
    """Reports that the program has paused or resumed, and its frames and variables."""
    remarks: tuple[str, ...] = ()
    """Lines for the output, such as about a loop without a wait; ids of actions are in braces."""

    def __bool__(self) -> bool:
        """Return whether the run has sent anything new; a prompt that still waits for its answer is nothing new."""
        return bool(
            self.rows or self.ended or self.spoken or self.branched or self.pauses or self.remarks
        )


def describe_remarks(
    event: protocol.BusyLoop | protocol.Plugged, recording: Recording
) -> Iterator[str]:
    """Yield the lines that the app adds to the output after an event of the run.

    The event is that the program is in a loop without a wait, or that a part was plugged in.
    """
    if isinstance(event, protocol.BusyLoop):
        yield describe_busy_loop(event)
    elif words := describe_newest(recording.plugged, recording.spec):
        yield words


class NearSampleWatch:
    """Looks for printed rows that are nearly samples, such as `speed: 5 cm`, and gives one hint in each run."""

    def __init__(self) -> None:
        self._told: Recording | None = None
        """The last run of which a line was reported."""

    def look(self, recording: Recording, rows: list[OutputRow]) -> list[str]:
        """Return a hint for the output if one of the new rows is nearly a sample, as a list of one line.

        Each run gets at most one hint. The list is empty if no new row is nearly a sample, or if the run already had
        its hint.

        Args:
            recording: The run.
            rows: The new rows.
        """
        if self._told is recording or not (words := describe_near_sample(rows)):
            return []
        self._told = recording
        return [words]


def describe_contacts(telemetry: TelemetryView, spec: RunSpec) -> str:
    """Return in words where something solid stopped or pushed the robot, and whether it left the field.

    The text is empty if nothing of this happened.

    Raises:
        LogError: the recording is damaged.
    """
    contacts = find_standstill(telemetry, spec), find_push(telemetry, spec)
    left = [LEFT_FIELD] if has_left_field(telemetry, spec) else []
    return ", ".join([*(contact.words for contact in contacts if contact), *left])
