"""Inspection of a paused program: threads, frames, variables, watches."""

from __future__ import annotations

import ast
import json
import math
import os
import sys
import threading
import types
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import asdict
from typing import Any, assert_never

from tuisim.base.data_class import dataclass
from tuisim.engine.core.motors import POSITION, TIMED, Motor
from tuisim.engine.core.profile import NS_PER_S
from tuisim.engine.core.sensors import build_reader
from tuisim.engine.core.state import Present
from tuisim.engine.protocol import FrameState, Inspect, Inspected, ThreadState, Variable, Watched
from tuisim.engine.runtime.debugger.fork import run_apart
from tuisim.engine.runtime.debugger.tracer import Tracer
from tuisim.engine.runtime.debugger.value_text import Renderer, cut, evaluate, name_type
from tuisim.engine.runtime.patches.replacement import Replacement
from tuisim.engine.runtime.scheduler import FOREVER, ScheduledThread, Scheduler
from tuisim.engine.runtime.session import Session
from tuisim.engine.runtime.stack import PACKAGE_FOLDER
from tuisim.engine.shim.waits import Wait, wait_of

_LIBRARIES = tuple(os.sep + name + os.sep for name in ("ev3dev2", "ev3dev"))
_ADVANCING = (Session._pass.__code__, Session.advance.__code__)


def describe_wait(session: Session, task: ScheduledThread, frame: types.FrameType | None) -> str:
    """Return a text that says what a thread waits for and until when; empty if the thread is ready to run.

    Args:
        session: The run.
        task: The thread.
        frame: Its innermost frame.
    """
    frames = list(_walk_frames(frame))
    until_ns = _find_end_ns(session, task, frames)
    until = f" until {until_ns / NS_PER_S:.2f} s" if until_ns is not None else ""
    for depth, library_frame in enumerate(frames):
        note = _describe_call(session, library_frame, frames[depth + 1 :], until)
        if note:
            return note
    return f"waits{until}" if until else ""


def _walk_frames(frame: types.FrameType | None) -> Iterator[types.FrameType]:
    while frame is not None:
        file = frame.f_code.co_filename
        if (
            file.startswith(PACKAGE_FOLDER)
            or any(name in file for name in _LIBRARIES)
            or _is_library(file)
        ):
            yield frame
            frame = frame.f_back
            continue
        return


def _is_library(file: str) -> bool:
    folder = os.path.dirname(os.__file__) + os.sep
    return file.startswith((folder, "<frozen"))


def _find_end_ns(
    session: Session, task: ScheduledThread, frames: list[types.FrameType]
) -> int | None:
    """Return the simulated time in ns at which a thread's wait ends; None if it does not wait, or has no time limit."""
    if task.order:
        return None if task.wake_ns == FOREVER else task.wake_ns
    for frame in frames:
        if frame.f_code in _ADVANCING and frame.f_locals.get("self") is session:
            until: int = frame.f_locals["until"]
            return until
    return None


def _describe_call(
    session: Session, frame: types.FrameType, outer: list[types.FrameType], until: str
) -> str:
    """Return a text that says what a call of the runtime or of the library waits for; empty if the call does not wait.

    Args:
        session: The run.
        frame: The call.
        outer: The callers of the frame, innermost first.
        until: The end of the text, which says when the wait ends.
    """
    match wait_of(frame.f_code):
        case None:
            return ""
        case Wait.SLEEP:
            return f"sleeps{until}"
        case Wait.FILES:
            return f"waits for timers and files{until}"
        case Wait.LOOP:
            return "computes without letting time pass"
        case Wait.MOTOR:
            return _describe_motors(session, outer, until)
        case Wait.INPUT:
            return "waits in input()"
        case Wait.BUTTONS:
            return _describe_buttons(frame.f_locals)
        case Wait.BUTTON_EVENT:
            return "waits for a button"
        case Wait.SOUND:
            return f"sounds{until}"
        case Wait.READING:
            return f"reads {_describe_reading(frame, outer)}{until}"
        case Wait.THREAD:
            return f"waits for the thread {getattr(frame.f_locals['self'], 'name', '')}{until}"
        case Wait.LOCK:
            return f"waits for {_lock_owner(outer)}{until}"
        case other:
            assert_never(other)


def _describe_reading(read: types.FrameType, outer: list[types.FrameType]) -> str:
    """Return what the program reads, by its own names, such as `gyro.angle`.

    If no frame in `outer` is a property of the library, it is the driver's attribute, such as `value0`.
    """
    properties = [frame for frame in outer if _is_property(frame)]
    if not properties:
        return str(read.f_locals["name"])
    device = properties[-1].f_locals["self"]
    program = outer[-1].f_back
    spaces = (program.f_locals, program.f_globals, program.f_builtins) if program else ()
    names = (name for space in spaces for name, value in space.items() if value is device)
    return f"{next(names, type(device).__name__)}.{properties[-1].f_code.co_name}"


def _is_property(frame: types.FrameType) -> bool:
    owner = frame.f_locals.get("self")
    return isinstance(getattr(type(owner), frame.f_code.co_name, None), property)


def _lock_owner(outer: list[types.FrameType]) -> str:
    names = [
        (os.path.basename(frame.f_code.co_filename), frame.f_code.co_qualname) for frame in outer
    ]
    for file, name in names:
        if file == "queue.py":
            return "a queue"
        if file == "threading.py" and name.partition(".")[0] in ("Event", "Barrier", "Semaphore"):
            return f"a{'n' if name.startswith('E') else ''} {name.partition('.')[0].lower()}"
    return "a condition" if ("threading.py", "Condition.wait") in names else "a lock"


def _describe_buttons(names: dict[str, Any]) -> str:
    parts = []
    for key, verb in (("to_press", ""), ("to_release", " to be released")):
        names_ = names.get(key) or ()
        buttons = [names_] if isinstance(names_, str) else list(names_)
        if buttons:
            parts.append(f"{' and '.join(map(str, buttons))}{verb}")
    return f"waits for the button {', '.join(parts)}" if parts else "waits for a button"


def _sort_motors(session: Session) -> list[tuple[str, Motor]]:
    return sorted(session.sim.motors_by_port.items(), key=lambda one: one[0])


def _describe_motors(session: Session, outer: list[types.FrameType], until: str) -> str:
    every = _sort_motors(session)
    owners = [frame.f_locals.get("self") for frame in outer]
    waited = {path for owner in owners for path in _list_paths(owner)}
    of_pybricks = [getattr(owner, "simulated", None) for owner in owners]
    named = [
        motor_pair
        for index, motor_pair in enumerate(every)
        if any(path.endswith(f"/motor{index}") for path in waited)
        or any(motor_pair[1] is motor for motor in of_pybricks)
    ]
    moving = [motor_pair for motor_pair in named or every if motor_pair[1].mode]
    if not moving:
        return f"waits for a motor{until}"
    return "waits for " + " and ".join(
        _describe_goal(session, port, motor) for port, motor in moving
    )


def _list_paths(owner: object) -> list[str]:
    attributes = getattr(owner, "__dict__", {})
    if isinstance(path := attributes.get("_path"), str):
        return [path]
    motors = attributes.get("motors")
    return (
        [path for motor in motors.values() for path in _list_paths(motor)]
        if isinstance(motors, dict)
        else []
    )


def _describe_goal(session: Session, port: str, motor: Motor) -> str:
    if motor.mode == POSITION:
        goal_deg = round(motor.goal_deg * session.sim.scales.get(motor, 1.0))
        return f"motor {port} to reach {goal_deg}°"
    if motor.mode == TIMED:
        return f"motor {port} to stop at {session.sim.compute_due_ns(math.ceil(motor.end_tick)) / NS_PER_S:.2f} s"
    return f"motor {port} to stop"


LOOK_LIMIT_S = 0.3
"""Time for the program's own code to render all values together, in real seconds."""
TOO_LONG = "values that the program's own code computes take too long"
MAX_NAMES = 200
MAX_FRAMES = 200
MAX_WATCHES = 50
_UNSHOWN = (types.ModuleType, types.FunctionType, types.BuiltinFunctionType, type, Replacement)
"""Types of globals that are not listed: imports and definitions, not data."""

Names = list[tuple[str, str, str]]
"""Name, type and text of each variable."""


@dataclass(frozen=True, slots=True)
class _Place:
    """A thread and one of its frames, to be inspected."""

    task: ScheduledThread
    top: types.FrameType | None
    """Innermost frame of the thread, including library and runtime frames."""
    frames: list[types.FrameType]
    """The program's own frames, innermost first."""
    at: int

    @property
    def frame(self) -> types.FrameType | None:
        return self.frames[self.at] if self.frames else None


class Inspector:
    """A reader of the state of a paused run: its threads, stack, variables and watched expressions.

    Args:
        session: The run.
        scheduler: The program's threads.
        tracer: Knows which code is the program's own.
        module: Holds the program's global names.
        prepared: Identities of the objects that existed before the program, by name; they are not listed.
    """

    def __init__(
        self,
        session: Session,
        scheduler: Scheduler,
        tracer: Tracer,
        module: Mapping[str, Any],
        prepared: Mapping[str, int],
    ) -> None:
        self._prepared = prepared
        self._session = session
        self._scheduler = scheduler
        self._tracer = tracer
        self._module = module
        self._seen: dict[tuple[str, str], dict[str, str]] = {}
        """Texts of the names at the last inspection, by scope."""

    def look(self, wanted: Inspect, go_on: Callable[[], bool]) -> Inspected:
        """Return the state of the run at a pause.

        Args:
            wanted: The request, which names a thread, a frame and watched expressions.
            go_on: Called when a command arrives during the inspection; returns whether to go on reading the values.
        """
        tops = sys._current_frames()
        place = self._place(wanted, tops)
        values, note = self._collect_values(place, wanted.watches[:MAX_WATCHES], go_on)
        frame = place.frame
        scope = (
            (frame.f_code.co_filename, frame.f_code.co_qualname) if frame is not None else ("", "")
        )
        variables = self._mark_changes(("local", *scope), values["locals"])
        found_globals = self._mark_changes(("global", "", ""), values["globals"])
        return Inspected(
            tick=self._session.sim.tick,
            time_ns=self._session.now,
            thread=self.name_thread(place.task),
            frame=place.at,
            waiting=describe_wait(self._session, place.task, place.top),
            threads=tuple(self._build_thread_state(task, tops) for task in self._scheduler.tasks),
            stack=tuple(
                self._build_frame_state(own_frame) for own_frame in place.frames[:MAX_FRAMES]
            ),
            variables=variables,
            globals=found_globals,
            watches=tuple(Watched(*watch) for watch in values["watches"]),
            note=note,
            present=Present(**values["present"]) if "present" in values else None,
            rows=self._session.output.writer.rows,
        )

    def name_thread(self, task: ScheduledThread) -> str:
        """Return the name of a thread, as the program sees it."""
        threads: Any = threading
        thread = threads._active.get(task.ident)
        name = getattr(thread, "_name", "")
        return cut(str(name), 60) if isinstance(name, str) and name else f"thread {task.ident}"

    # Selection

    def _place(self, wanted: Inspect, tops: Mapping[int, types.FrameType]) -> _Place:
        tasks = self._scheduler.tasks
        task = next(
            (task for task in tasks if wanted.thread and self.name_thread(task) == wanted.thread),
            None,
        )
        task = task or self._scheduler.current
        top = tops.get(task.ident)
        frames = self._tracer.own_frames(top)
        return _Place(task, top, frames, max(0, min(wanted.frame, len(frames) - 1)))

    def _build_thread_state(
        self, task: ScheduledThread, tops: Mapping[int, types.FrameType]
    ) -> ThreadState:
        top = tops.get(task.ident)
        paused = task is self._scheduler.current
        file = self._session.program_file
        frames = [
            frame for frame in self._tracer.own_frames(top) if frame.f_code.co_filename == file
        ]
        line = frames[0].f_lineno if frames else 0
        return ThreadState(
            self.name_thread(task), line or 0, describe_wait(self._session, task, top), paused
        )

    def _build_frame_state(self, frame: types.FrameType) -> FrameState:
        file = frame.f_code.co_filename
        shown_file = "" if file == self._session.program_file else file
        return FrameState(frame.f_code.co_name, frame.f_lineno or 0, shown_file)

    # Variables

    def _collect_values(
        self, place: _Place, watches: tuple[str, ...], go_on: Callable[[], bool]
    ) -> tuple[dict[str, Any], str]:
        frame = place.frame
        # Local variables of this thread are read in the copy: `f_locals` would keep the values alive in this process.
        local = None if frame is None or place.task is self._scheduler.current else frame.f_locals

        def read_values(seconds: float, expressions: tuple[str, ...]) -> dict[str, Any] | None:
            def work() -> bytes:
                return json.dumps(self._collect_names(frame, local, expressions, seconds)).encode(
                    "utf-8", "replace"
                )

            answer = run_apart(self._session, self._scheduler, work, LOOK_LIMIT_S, go_on)
            values: dict[str, Any] | None = None if answer is None else json.loads(answer)
            return values

        whole = read_values(LOOK_LIMIT_S / 2, watches)
        if whole is not None:
            return whole, ""
        # Read again without running the program's own code, which may never return.
        plain = read_values(0.0, ()) or {"locals": [], "globals": []}
        return {**plain, "watches": [(text, "", "takes too long") for text in watches]}, TOO_LONG

    def _collect_names(
        self,
        frame: types.FrameType | None,
        local: Mapping[str, Any] | None,
        watches: tuple[str, ...],
        seconds: float,
    ) -> dict[str, Any]:
        """Return variables and watched expressions as data for JSON; called in the copy of the process.

        Args:
            frame: The frame whose names are read; None for the program's global names only.
            local: The local names; None for those of the frame.
            watches: The watched expressions.
            seconds: CPU time for the program's own code.
        """
        inside = self._module if frame is None else frame.f_globals
        if frame is None:
            names = inside
        elif local is None:
            names = frame.f_locals
        else:
            names = local
        own_module = names is inside
        renderer = Renderer(seconds)
        plain = _copy_names(names)
        visible = {**inside, **plain}
        builtin = frame.f_builtins if frame is not None else self._module.get("__builtins__", {})
        present = self._session.sim.read_present(self._session.now)
        watched = {**self._read_columns(watches, present), **visible}
        return {
            "present": asdict(present),
            "watches": [(text, *evaluate(renderer, text, watched, builtin)) for text in watches],
            "locals": _render_names(
                renderer, self._own_names(plain) if own_module else plain, whole=not own_module
            ),
            "globals": []
            if own_module
            else _render_names(renderer, self._own_names(inside), whole=False),
        }

    def _read_columns(self, watches: tuple[str, ...], present: Present) -> dict[str, float]:
        """Return the present values of the recording's columns whose names occur in watched expressions, by name."""
        sim = self._session.sim
        instant = present.apply(sim.build_instant())
        field = self._session.field
        readers = {
            name: build_reader(name, sim.spec) for text in watches for name in _find_names(text)
        }
        return {
            name: read(instant, sim.spec, field)
            for name, read in readers.items()
            if read is not None
        }

    def _own_names(self, names: Mapping[str, Any]) -> dict[str, Any]:
        prepared = self._prepared
        return {name: value for name, value in names.items() if prepared.get(name) != id(value)}

    def _mark_changes(self, scope: tuple[str, ...], names: Names) -> tuple[Variable, ...]:
        key = (scope[0], "\0".join(scope[1:]))
        before = self._seen.get(key)
        if names:
            self._seen[key] = {name: text for name, _, text in names}
        return tuple(
            Variable(name, kind, text, before is not None and before.get(name) != text)
            for name, kind, text in names
        )


def _find_names(expression: str) -> set[str]:
    with suppress(SyntaxError, ValueError, RecursionError, MemoryError):
        return {
            node.id
            for node in ast.walk(ast.parse(expression.strip(), mode="eval"))
            if isinstance(node, ast.Name)
        }
    return set()


def _copy_names(names: Mapping[str, Any]) -> dict[str, Any]:
    """Return a namespace as a dict; empty if the copy fails, because the namespace may be a mapping of the program."""
    try:
        return dict(names)
    except Exception:  # the mapping's own code may raise anything
        return {}


def _render_names(renderer: Renderer, names: Mapping[str, Any], whole: bool) -> Names:
    """Return a row for each variable: its name, the name of its value's type, and its value as text.

    Names with `__` at the start are left out; unless `whole` is True, so are modules, functions and classes.
    """
    texts: Names = []
    for name, value in list(names.items()):
        if not isinstance(name, str) or name.startswith(("__", ".")):
            continue
        if not whole and issubclass(type(value), _UNSHOWN):
            continue
        texts.append((cut(name, 80), name_type(value), renderer.render(value)))
        if len(texts) == MAX_NAMES:
            break
    return texts
