"""What a program waits for is said once in a run."""

from __future__ import annotations

from tests.tasks.reasons.test_waited import SPEC, Record, poll
from tuisim.engine.protocol import End, Ended
from tuisim.engine.runs.recorded_run import Recording
from tuisim.tasks.reasons.waiting import WaitWatch, describe_so_far

SENTENCE = (
    "— touch sensor on in1 was never pressed: {panel-brick} opens the brick, where 1 presses it"
)


def test_what_a_standing_robot_waits_for_is_told_once_in_the_app(record: Record) -> None:
    watch = WaitWatch()
    recorder = record(SPEC)
    poll(recorder, "in1", "TOUCH")
    recording = Recording(recorder.end(End.TIME_LIMIT))
    assert describe_so_far(recording) == (
        "Nothing found until 7.00 s: the robot stands still in line 5. {pause} resumes"
    )
    assert watch.look(recording, None, False, lambda _: None) == []
    assert watch.look(recording, None, True, lambda _: None) == [SENTENCE]
    end = Ended(End.STOPPED, 700, 7_000_000_000)
    assert watch.look(recording, end, False, lambda _: None) == []
    assert WaitWatch().look(recording, end, False, lambda _: None) == [SENTENCE]
