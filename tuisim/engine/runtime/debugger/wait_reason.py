"""What a thread of a paused program is waiting for, derived from its stack."""

from __future__ import annotations

import math
import os
import types
from collections.abc import Iterator
from typing import Any, assert_never

from tuisim.engine.core.motors import POSITION, TIMED, Motor
from tuisim.engine.core.profile import NS_PER_S
from tuisim.engine.runtime.scheduler import FOREVER, ScheduledThread
from tuisim.engine.runtime.session import Session
from tuisim.engine.runtime.stack import PACKAGE_FOLDER
from tuisim.engine.shim.waits import Wait, wait_of

_LIBRARIES = tuple(os.sep + name + os.sep for name in ("ev3dev2", "ev3dev"))
_ADVANCING = (Session._pass.__code__, Session.advance.__code__)


def describe_wait(session: Session, task: ScheduledThread, frame: types.FrameType | None) -> str:
    """Return what a thread waits for and until when; empty if it is ready to run.

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
    """Return when the wait ends; None if it has no end time, or there is no wait."""
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
    """Return what a call of the runtime or the library waits for; empty if the call itself does not wait."""
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
    """Return what the program reads, in its own names, such as `gyro.angle`.

    Without a property of the library in the frames `outer`, it is the driver's attribute, such as `value0`.
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
        return f"motor {port} to reach {motor.goal_deg:.0f}°"
    if motor.mode == TIMED:
        return f"motor {port} to stop at {session.sim.compute_due_ns(math.ceil(motor.end_tick)) / NS_PER_S:.2f} s"
    return f"motor {port} to stop"
