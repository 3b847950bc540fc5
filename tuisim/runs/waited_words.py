"""What a run waited for, in words: what it was, and the option, key or file that gives it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import assert_never

from tuisim.core.spec import EMPTY_MAT, RunSpec
from tuisim.runs.run_folder import StoredRun
from tuisim.runs.waited import Awaited, Subject, find_awaited


def describe_wait(run: StoredRun) -> str:
    """Return what a run waited for in one sentence without its full stop; empty if for nothing."""
    return "; ".join(
        f"{describe_awaited(one)}: {name_remedy(one, run.spec)}" for one in find_awaited(run)
    )


def describe_wait_with_keys(awaited: Iterable[Awaited], spec: RunSpec) -> str:
    """Return the same for the app, with ids of actions in braces; empty if nothing was waited for."""
    return "; ".join(
        f"{describe_awaited(one)}: {name_remedy_with_keys(one, spec)}" for one in awaited
    )


def describe_awaited(awaited: Awaited) -> str:
    """Return what did not come."""
    port, value = awaited.port, awaited.value
    match awaited.subject:
        case Subject.BUTTONS:
            return f"read the brick's buttons {awaited.times:,} times, none was pressed"
        case Subject.TOUCH:
            return f"touch sensor on {port} was never pressed"
        case Subject.REMOTE:
            return f"infrared sensor on {port}: no button of the remote was pressed"
        case Subject.BEACON:
            return f"infrared sensor on {port} found no beacon"
        case Subject.COLOR:
            return f"colour sensor on {port} saw only {value}"
        case Subject.DISTANCE:
            return f"ultrasonic sensor on {port} saw nothing nearer than {value}"
        case Subject.PROXIMITY:
            return f"infrared sensor on {port} saw nothing nearer than {value}"
        case Subject.CONNECTION:
            return f"socket.accept in line {awaited.line}: nobody connected"
        case Subject.DATA:
            return f"a socket in line {awaited.line}: nothing arrived"
        case other:
            assert_never(other)


def name_remedy(awaited: Awaited, spec: RunSpec) -> str:
    """Return the option or file that gives it, for users of the command line."""
    match awaited.subject:
        case Subject.BUTTONS:
            return "--press enter@1, or K in the app"
        case Subject.TOUCH:
            return f"--press {awaited.port}@2"
        case Subject.REMOTE:
            return "--press remote.left_up@1-3"
        case Subject.BEACON:
            return "[beacon] in a world file places one (tuisim guide world-files)"
        case Subject.COLOR if spec.world.background == EMPTY_MAT:
            return "-b Loop gives it a line (tuisim backgrounds)"
        case Subject.COLOR:
            return "-x, -y and -a place it elsewhere on the mat"
        case Subject.DISTANCE | Subject.PROXIMITY:
            walls = "" if spec.world.walls else "--walls on, or "
            return f"{walls}-o Central_post puts something before it (tuisim obstacles)"
        case Subject.CONNECTION | Subject.DATA:
            return "--speed 1 gives the other program the time to come"
        case other:
            assert_never(other)


def name_remedy_with_keys(awaited: Awaited, spec: RunSpec) -> str:
    """Return the key that gives it, as an id of an action in braces."""
    match awaited.subject:
        case Subject.BUTTONS:
            return "{panel-brick} opens the brick, whose buttons the arrows and Enter press"
        case Subject.TOUCH:
            return f"{{panel-brick}} opens the brick, where {awaited.port[2:]} presses it"
        case _:
            return name_remedy(awaited, spec)
