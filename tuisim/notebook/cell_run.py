"""Runs the program of a cell: output, images, answers of the responder, kernel interrupts."""

from __future__ import annotations

import json
import signal
import sys
import threading
import time
from collections.abc import Callable, Mapping
from contextlib import closing
from dataclasses import replace
from functools import partial
from itertools import islice
from queue import Empty
from types import FrameType
from typing import TYPE_CHECKING, Any, TypeVar

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError, HostError, counted
from tuisim.base.source import Program
from tuisim.engine.core.spec import RunSpec
from tuisim.engine.mat_cache import FieldFiles
from tuisim.engine.protocol import Answer, Ended, Message, Reply, Wheels, describe_state
from tuisim.engine.runs.handle import RunHandle, RunOptions, start_run
from tuisim.engine.runs.records import OutputRow, Stream
from tuisim.engine.runs.run_folder import StoredRun, field_files
from tuisim.engine.runs.samples import Sample, describe_near_sample, list_samples
from tuisim.engine.runs.store import RunStore
from tuisim.notebook.cell_output import CellOutput
from tuisim.notebook.display import Scene, Stage, start_record
from tuisim.notebook.image_log import SENT_DATA, ArrayReader, ImageLog, parse_side
from tuisim.notebook.old_formats import format_sent
from tuisim.pictures.scene.pen import Piece
from tuisim.programs.plugged_words import list_parts
from tuisim.settings.presses import press_actions

if TYPE_CHECKING:
    from tuisim.notebook.app_view import AppView

_START_WITHIN_S = 60.0


class AppRun:
    """A run that the app of a cell has started, with the interface of a `RunHandle`; its output is read from the store.

    Args:
        view: The app, which has been requested to start a run.
        is_interrupted: Returns whether the user has interrupted the cell.

    Raises:
        HostError: the app cannot start the run or does not answer, or the user has interrupted the cell before the
            start.
    """

    waiting_for_reply = False
    waiting_for_input: str | None = None
    """None, as the app itself asks its user for input."""

    def __init__(self, view: AppView, is_interrupted: Callable[[], bool]) -> None:
        self._view = view
        self._is_interrupted = is_interrupted
        self.ended: Ended | None = None
        self.wheels = Wheels()
        self.run_id = str(self._wait_for_news("run", "problem")["id"])
        self.output = RunStore().load_run(self.run_id).output

    def _wait_for_news(self, *kinds: str) -> Mapping[str, Any]:
        """Wait for the next message of some kinds from the app, and return the message.

        Raises:
            HostError: the message is a problem, the user has interrupted the cell, or no message comes in time.
        """
        until_s = time.monotonic() + _START_WITHIN_S
        while self._view.is_alive and time.monotonic() < until_s:
            if self._is_interrupted():
                self._view.ask("stop")
                raise HostError("interrupted before the app had begun")
            news = self._receive(0.2)
            if news.get("what") == "problem" and "problem" in kinds:
                raise HostError(str(news["text"]))
            if news.get("what") in kinds:
                return news
        raise HostError(
            "the app in the cell does not answer", "%sim_app --off runs cells without it"
        )

    def _receive(self, timeout_s: float) -> Mapping[str, Any]:
        try:
            return (
                self._view.told.get(timeout=timeout_s)
                if timeout_s
                else self._view.told.get_nowait()
            )
        except Empty:
            return {}

    def wait_for_event(self, timeout_s: float) -> None:
        """Wait until the run has ended, for at most `timeout_s` seconds."""
        if self.ended is None:
            news = self._receive(timeout_s)
            if (
                news.get("what") == "ended" and news.get("id") == self.run_id
            ) or not self._view.is_alive:
                self.ended = self.stored().end

    def pump(self) -> list[Message]:
        """Return an empty list: the app handles the events of the run."""
        return []

    def send(self, command: Message) -> None:
        """Ignore a command: the app sends its own commands."""

    def stop(self) -> None:
        """Send the app a request to stop the program."""
        if self.ended is None and self._view.is_alive:
            self._view.ask("stop")

    def wait(self, timeout_s: float) -> None:
        """Wait until the run has ended, for at most `timeout_s` seconds."""
        until = time.monotonic() + timeout_s
        while self.ended is None and (left_s := until - time.monotonic()) > 0:
            self.wait_for_event(left_s)

    kill = stop

    def close(self) -> None:
        """Do nothing: the run belongs to the app."""

    def stored(self) -> StoredRun:
        """Return the run as it is in the store."""
        return RunStore().load_run(self.run_id)


POLL_S = 0.02
"""Interval at which printed lines appear in the cell."""

STOP_WAIT_S = 1.0
ROWS_AT_ONCE = 2000
"""Lines shown between two checks for an interrupt."""

ROWS_AFTER_INTERRUPT = 1000
"""Maximum lines shown after an interrupt; the log has all of them."""

ROWS_A_DRAWING = 10_000
"""Lines searched for samples between two checks for an interrupt."""

BYTES_IN_A_HURRY = 1 << 20
"""Output processed at once."""

TEXT_PREFIX = "PY::"
NOTEBOOK_PREFIXES = (TEXT_PREFIX, SENT_DATA)
"""Prefixes of lines for the responder."""

JSON_PREFIX = "JSON::"
"""Begins an answer that the program gets, where answers are text."""

RESPONSE_HEADING = "PY RESPONSE"

Responder = Callable[[str], object]
Result = TypeVar("Result")


@dataclass(frozen=True, slots=True)
class Listener:
    """The functions of a notebook that are called with a program's output, and whose answers the program can get."""

    responder: Responder | None = None
    """Called with each line for the notebook, in collaborative mode."""
    in_texts: bool = False
    """Whether the responder talks as under the old simulator: it gets whole lines, with the pixels in them, and only
    answers that begin with `JSON_PREFIX` reach the program."""
    image_handler: Callable[[], object] | None = None
    """Called after each logged pixel array; its answers are texts."""

    @property
    def answers(self) -> bool:
        """Whether there is a function that can answer the program."""
        return self.responder is not None or self.image_handler is not None


@dataclass(frozen=True, slots=True)
class CellRun:
    """The program of a cell, with its world and options, to be run."""

    program: Program
    spec: RunSpec
    files: FieldFiles
    speed: float
    """As in `RunOptions`."""
    presses: tuple[str, ...]
    """What a hand presses, as texts."""
    refresh_s: float
    traces: tuple[Piece, ...]
    """Pen traces of earlier runs on the mat."""
    listener: Listener
    images: ImageLog
    """Gets the pixel arrays that the program logs."""
    quiet: bool
    """Whether speech is not shown either."""


def run_cell(
    cell: CellRun,
    stage: Stage,
    begun: Callable[[StoredRun, Wheels], None],
    view: AppView | None = None,
) -> StoredRun:
    """Run the program of a cell and show it; block until it ends or the kernel is interrupted. Return the run.

    Args:
        cell: The program.
        stage: The displays of the cell.
        begun: Called with the run and the registers of its wheel motors, as soon as the run has a recording, and again
            at its end.
        view: The app, if it has been requested to start the run; None to start the run here.

    Raises:
        ConfigError: a function of the notebook that answers the program, such as `roboSim.responder`, has returned a
            value that a program cannot get; the run has been stopped.
    """
    store = RunStore()
    paced = cell.speed > 0
    options = RunOptions(
        live=paced,
        speed=cell.speed,
        asks_user=True,
        time_waits=not paced,
        replies=cell.listener.answers,
        actions=press_actions(cell.presses, cell.spec.profile.tick_hz),
    )
    with (
        Interruption() as interruption,
        closing(
            AppRun(view, lambda: interruption.count > 0)
            if view
            else start_run(cell.program, cell.spec, options, store)
        ) as handle,
    ):
        run = store.load_run(handle.run_id)
        if view is not None:
            # In the app, the user may have moved the robot before the run.
            cell = replace(cell, spec=run.spec, files=field_files(run.spec))
        begun(run, handle.wheels)
        screen = _Screen(cell, stage, run)
        try:
            _Follower(cell, handle, screen, interruption, run).follow()
        except BaseException:  # whatever a responder raises, the program must not outlive the cell
            cell.images.mark_incomplete(run)
            handle.stop()
            handle.wait(STOP_WAIT_S)
            raise
        finally:
            handle.close()
            done = handle.stored()
            begun(done, handle.wheels)
            # After an interrupt, millions of lines are not read, as the user does not want to wait.
            hurry = interruption.count > 0
            screen.draw(describe_end(done, hurry=hurry), ROWS_A_DRAWING if hurry else None)
    return done


def describe_end(run: StoredRun, *, hurry: bool = False) -> str:
    """Return a status line of a finished run: state, simulated time, samples.

    Args:
        run: The run.
        hurry: Whether to leave out the number of samples if counting them would be slow.
    """
    state = describe_state(run.state, run.end.summary if run.end else "")
    plugged = f" · plugged in {parts}" if (parts := list_parts(run.plugged)) else ""
    status = f"{state} · {run.time_s:.3f} s{plugged}"
    if hurry and run.output.length > BYTES_IN_A_HURRY:
        return status
    samples = counted(len(list_samples(run.output.rows())), "sample")
    words = [status, samples, describe_near_sample(run.output.rows())]
    return " · ".join(filter(None, words))


class Interruption:
    """Counts the user's interrupts in a `with` block, where they raise no exception.

    An exception could come at a bad moment, such as between starting and storing a child. Only in the user's functions
    an interrupt raises KeyboardInterrupt as usual, see `call`.
    """

    def __init__(self) -> None:
        self.count = 0
        self._allowed = False
        self._before: Any = None

    def __enter__(self) -> Interruption:
        # Python delivers signals to the main thread only.
        if threading.current_thread() is threading.main_thread():
            self._before = signal.signal(signal.SIGINT, self._on_signal)
        return self

    def __exit__(self, *_: object) -> None:
        if self._before is not None:
            signal.signal(signal.SIGINT, self._before)

    def _on_signal(self, _number: int, _frame: FrameType | None) -> None:
        self.count += 1
        if self._allowed:
            raise KeyboardInterrupt

    def call(self, act: Callable[[], Result]) -> Result | None:
        """Call a user's function; an interrupt ends it immediately.

        Returns:
            Its result; None if it was interrupted.
        """
        self._allowed = True
        try:
            return None if self.count else act()
        except KeyboardInterrupt:
            # If the user's function itself raised it, no signal was counted.
            self.count = max(1, self.count)
            return None
        finally:
            self._allowed = False


class _Follower:
    def __init__(
        self,
        cell: CellRun,
        handle: RunHandle | AppRun,
        screen: _Screen,
        interruption: Interruption,
        run: StoredRun,
    ) -> None:
        self._cell = cell
        self._handle = handle
        self._screen = screen
        self._interruption = interruption
        self._run, self._arrays = run, ArrayReader(run)
        # Nothing is folded if the notebook's functions print, too: their text belongs between the program's lines.
        folds = screen.redraws and not cell.listener.answers
        self._printed = CellOutput(folds=folds, quiet=cell.quiet)
        self._answers: list[Any] = []
        """Answers of the responder that have not been sent to the program."""
        self._stopping = False

    def follow(self) -> None:
        """Show the output of the run and answer the program; block until the run ends."""
        handle = self._handle
        interruption = self._interruption
        # Panels are shown before printed text, so that the order of outputs does not depend on the program's speed.
        self._screen.draw_if_due()
        more = False
        while handle.ended is None:
            if interruption.count > 1:
                handle.kill()
            elif interruption.count and not self._stopping:
                self._stopping = True
                handle.stop()
            handle.wait_for_event(0.0 if more else POLL_S)
            handle.pump()
            more = self._relay()
            # An answer must take into account everything printed before the question.
            if not more and not interruption.count:
                self._send_answers()
            if not interruption.count:
                self._screen.draw_if_due()
        self._finish()

    def _relay(self) -> bool:
        """Show new output and call the notebook's functions with its lines.

        Return whether there is more output already.
        """
        rows = self._handle.output.read_new_rows(ROWS_AT_ONCE)
        start = 0
        for stop, row in enumerate(rows, 1):
            side = parse_side(row)
            addressed = self._is_addressed(row)
            if side or addressed:
                # The lines up to this one are shown first, as the notebook's functions may print something about it.
                self._printed.show(rows[start:stop])
                start = stop
            if side:
                self._log_arrays(row)
            if addressed:
                self._hear(row)
        self._printed.show(rows[start:])
        return len(rows) == ROWS_AT_ONCE

    def _is_addressed(self, row: OutputRow) -> bool:
        listens = self._cell.listener.responder is not None
        return listens and row.stream == Stream.STDOUT and row.text.startswith(NOTEBOOK_PREFIXES)

    def _log_arrays(self, row: OutputRow) -> None:
        handler = self._cell.listener.image_handler
        for array in self._arrays.read_arrays(row):
            self._cell.images.add(self._run, array)
            if handler is not None and not array.sent:
                self._take_text(
                    "roboSim.live_image_handler", self._interruption.call(handler) or None
                )

    def _hear(self, row: OutputRow) -> None:
        listener = self._cell.listener
        call = self._interruption.call
        assert listener.responder is not None
        if not listener.in_texts:
            answer = call(partial(listener.responder, row.text.removeprefix(TEXT_PREFIX)))
            self._answers += [] if answer is None else [_build_message("roboSim.responder", answer)]
            return
        heard = (
            format_sent(self._arrays.read_pixels(row))
            if row.text.startswith(SENT_DATA)
            else row.text
        )
        self._take_text("roboSim.pyresponder", call(partial(listener.responder, heard)))

    def _take_text(self, who: str, answer: object) -> None:
        """Print the answer of a notebook's function below a heading, as the old simulator nbev3devsim did.

        If the answer begins with `JSON_PREFIX`, send the rest of it to the program.

        Args:
            who: The name of the function that gave the answer, for errors.
            answer: The answer; None for no answer.
        """
        if answer is None:
            return
        print(f"{RESPONSE_HEADING}\n{answer}")
        if isinstance(answer, str) and answer.startswith(JSON_PREFIX):
            self._answers.append(_parse_answer(who, answer.removeprefix(JSON_PREFIX)))

    def _send_answers(self) -> None:
        handle = self._handle
        if handle.waiting_for_reply:
            answers = self._answers
            self._answers = []
            handle.send(Reply(tuple(answers)))
        prompt = handle.waiting_for_input
        if prompt is not None:
            answer = self._interruption.call(partial(_ask, prompt))
            if not self._interruption.count:
                handle.send(Answer(answer, at_once=self._cell.speed == 0))

    def _finish(self) -> None:
        row_count = 0
        while not (self._interruption.count and row_count > ROWS_AFTER_INTERRUPT) and self._relay():
            row_count += ROWS_AT_ONCE
        self._printed.finish()
        if self._handle.output.read_new_rows(1):
            self._cell.images.mark_incomplete(self._run)
            print("… and more lines, which are in the log", file=sys.stderr)
        ended = self._handle.ended
        if (
            ended
            and ended.error
            and not any(row.stream == Stream.STDERR for row in self._handle.output.rows())
        ):
            print(ended.error.rstrip("\n"), file=sys.stderr)


class _Screen:
    def __init__(self, cell: CellRun, stage: Stage, run: StoredRun) -> None:
        self._cell = cell
        self._stage = stage
        self._run = run
        self._due = 0.0
        self._samples: list[Sample] = []
        self._position = 0
        """Position up to which the output has been searched for samples."""

    @property
    def redraws(self) -> bool:
        """Whether drawings in the cell can be updated in place."""
        return self._stage.redraws

    def draw_if_due(self) -> None:
        """Draw the run if nothing is drawn yet or the drawing is old.

        Do nothing if drawings cannot be updated in place.
        """
        if not self._stage.redraws or time.monotonic() < self._due:
            return
        self.draw(f"running · {self._run.telemetry.count / self._cell.spec.profile.tick_hz:.2f} s")
        # The pause begins at the end of the drawing, so that slow drawing does not take all the time.
        self._due = time.monotonic() + self._cell.refresh_s

    def draw(self, status: str, most_rows: int | None = ROWS_A_DRAWING) -> None:
        """Draw the current state of the run.

        Args:
            status: The status line.
            most_rows: How many new lines of output to search for samples; None for all.
        """
        cell = self._cell
        run = self._run
        if self._stage.is_enabled("chart"):
            for row, after in islice(run.output.read_rows(self._position), most_rows):
                self._samples += list_samples((row,))
                self._position = after
        last = run.telemetry.last() or start_record(cell.spec)
        traces = (*cell.traces, Piece.from_run(cell.spec, run.telemetry.array()))
        self._stage.show(
            Scene(cell.spec, cell.files, cell.program, last, traces, self._samples, run=run), status
        )


def _convert_plain(value: Any) -> Any:
    """Return a number or array of another library, such as NumPy, as Python's own type.

    Raises:
        TypeError: the value is neither a number nor an array.
    """
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"a {type(value).__name__}")


def _parse_answer(who: str, text: str) -> Any:
    try:
        return json.loads(text)
    except (ValueError, RecursionError) as error:
        raise ConfigError(
            f"the answer is not JSON: {error}", f'{JSON_PREFIX}{{"key": 1}} is one', key=who
        ) from None


def _build_message(who: str, answer: object) -> Any:
    try:
        return json.loads(json.dumps(answer, default=_convert_plain))
    except (TypeError, ValueError, RecursionError) as error:
        hint = "text, numbers, True, None, lists and dicts; None means no answer"
        raise ConfigError(f"the program cannot get {error}", hint, key=who) from None


def _ask(prompt: str) -> str | None:
    """Return a line that the user enters; if input is not possible, print why and return None."""
    from IPython.core.error import StdinNotImplementedError

    try:
        return input(prompt)
    # These come from a kernel whose front end has no input, from a shell at its end of input, and without stdin.
    except (StdinNotImplementedError, EOFError, OSError):
        print("tuisim: the program waits for input(), which is not supported here", file=sys.stderr)
        return None
