"""The parts that were plugged in during a run, in words."""

from __future__ import annotations

from collections.abc import Sequence

from tuisim.engine.core.plugged import LATE, LEFT, MOTOR_KIND_OF, RIGHT, PluggedPart
from tuisim.engine.core.spec import RunSpec
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.programs.robot.library import DEVICES, SENSES_WALLS


def describe_plugged(run: StoredRun) -> str:
    """Return a sentence about the parts that a run plugged in only when the program opened them.

    The text of the program had not shown these parts. The sentence also says how to have them from the start. The
    result is empty if no part was plugged in.
    """
    parts = list_parts(run.plugged)
    if not parts:
        return ""
    words = f"plugged in {parts}{_name_remedy(run.plugged, run.spec)}"
    hint = f"; `tuisim robots --from {run.number}` shows the robot" if run.number else ""
    return f"{run.program.name} opened parts that its source does not show: {words}{hint}"


def _name_remedy(parts: Sequence[PluggedPart], spec: RunSpec) -> str:
    """Return the option that adds walls for a sensor that was plugged in.

    The result is empty if no such sensor needs walls, or if the world has walls.
    """
    is_blind = spec.world.is_open and any(DEVICES.get(part.part) in SENSES_WALLS for part in parts)
    return "; there are no walls: --walls on" if is_blind else ""


def describe_newest(parts: Sequence[PluggedPart], spec: RunSpec) -> str:
    """Return a sentence about the part that was plugged in last.

    The two wheels are plugged in one after the other. For the left wheel, which is the first, the result is empty; the
    sentence for the right wheel names both.
    """
    last = parts[-2:] if parts[-1].role == RIGHT else parts[-1:]
    words = f"{list_parts(last)}{_name_remedy(last, spec)}"
    return "" if parts[-1].role == LEFT else f"— plugged in, because the program opened it: {words}"


def list_parts(parts: Sequence[PluggedPart]) -> str:
    """Return the parts as text, with their ports and the program's lines that use them; empty for none."""
    right = {(part.tick, part.line): part.port for part in parts if part.role == RIGHT}
    words = []
    wheels = {part.port: number for number, part in enumerate(parts) if part.role in (LEFT, RIGHT)}
    for number, part in enumerate(parts):
        if not part.role and wheels.get(part.port, 0) > number:
            # The motor is listed later, as that of a wheel.
            continue
        line = f" (line {part.line})" if part.line else ""
        kind = DEVICES.get(part.part) or f"{MOTOR_KIND_OF[part.part].replace('-', ' ')} motor"
        if part.role == LEFT:
            other = right.get((part.tick, part.line), "")
            words.append(f"wheels on {part.port} (left) and {other}{line}")
        elif part.role == LATE:
            words.append(f"{kind} on {part.port}, no wheel's since the robot had driven{line}")
        elif not part.role:
            words.append(f"{kind} on {part.port}{line}")
    return ", ".join(words)
