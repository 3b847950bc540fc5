"""Moves with an end that a program cut off, since it did not wait for them, or parted, since it waited for one."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Set
from typing import TYPE_CHECKING, Any

import numpy as np

from tuisim.base.data_class import dataclass
from tuisim.engine.core.commands.calls import Call
from tuisim.engine.runs.command_words import CALL_WORDS, Aim
from tuisim.programs.moves import UnwaitedMove
from tuisim.tasks.reasons.run_data import STOP_CALLS, RunData
from tuisim.tasks.reasons.unmet import Unmet

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[Any]

_BASE = (Call.MOVE_BASE,)
_TURNS = (Call.RUN_TO, Call.RUN_TO_REL_POS, Call.RUN_TO_ABS_POS)
_CALLS: Mapping[str, tuple[Call, ...]] = {
    "on_for_seconds": (Call.RUN_UNTIL, Call.RUN_TIMED),
    "on_for_degrees": _TURNS,
    "on_for_rotations": _TURNS,
    "on_to_position": _TURNS,
    "straight": _BASE,
    "turn": _BASE,
    "curve": _BASE,
    "arc": _BASE,
    "run_angle": (Call.MOVE,),
    "run_target": (Call.MOVE,),
    "run_time": (Call.RUN_AT,),
}
"""The commands with which methods move motors, by the name of the method."""
_GO_ON = (Call.RUN_TO_REL_POS, Call.RUN_TO_ABS_POS, Call.RUN_TIMED)
"""Moves that go on after the end of the program."""
_AT_ONCE_S = 0.1
"""A move that another one follows within this time, in s, has hardly begun."""
_DONE_SHARE = 0.8
"""A move of which this share is done is not cut off."""
_MAX_COMMANDS = 10_000
"""The number of commands that are examined; further commands are ignored."""
_MAX_HARDLY = 2
"""Ticks after which a motor has not yet moved."""
_SIDES = ("left", "right")
_MIN_WHEEL_DEG = 30.0
_MAX_IDLE_SHARE = 0.1
"""While one wheel turns by at least this angle, the other one, which turns by at most this share of it, stands."""
_SAME_SHARE = 0.3
"""Turns there and back that differ by less than this share were meant as a straight way."""
_MIN_MOVE_S = 0.3
"""Nobody misses a move that is cut off if it would have taken no longer than this, in s."""


@dataclass(frozen=True, slots=True)
class _Move:
    """A command that moves a motor or a drive base, and the next command to the same motor or drive base."""

    tick: int
    end: int
    call: Call
    values: list[float]
    part: int
    next_call: Call | None
    """The next command; None for the end of the run."""


def list_cut_moves(data: RunData) -> Iterator[Unmet]:
    """Yield the moves that the next command to the same part, or the end of the program, cut off.

    A part is a motor or a drive base.
    """
    unwaited = data.facts.list_unwaited_moves()
    if not unwaited:
        return
    calls = {call for each in unwaited for call in _CALLS.get(each.method, ())}
    for move in _list_moves(data, calls):
        fitting = [each for each in unwaited if move.call in _CALLS.get(each.method, ())]
        if call := _find_call(data, move, fitting):
            share = _describe_share(data, move)
            does = "stopped it" if move.next_call in STOP_CALLS else "began the next one"
            after = f"line {call.next_line} {does}"
            if not call.next_line:
                after = "the next one began" if move.next_call else "the program ended"
            text = f"{call.option} did not wait for this move, {share} when {after}"
            if share:
                yield Unmet(move.end / data.hz, call.line, text)


def list_parted_moves(data: RunData) -> Iterator[Unmet]:
    """Yield the straight moves that swerved because the program moved one wheel after the other.

    Args:
        data: The run.
    """
    for pair in data.facts.list_parted_moves():
        next_stays = data.find_stays(pair.next_line, pair.next_line)
        for start, end in data.find_stays(pair.first_line, pair.first_line):
            following = next((stay for stay in next_stays if stay[0] >= end), None)
            if following and _has_swerved(data.records, start, end, *following):
                text = (
                    f"{pair.method} waits until this wheel is done before line {pair.next_line} moves the other one: "
                    f"{pair.option} on the first drives both"
                )
                yield Unmet(start / data.hz, pair.first_line, text)


def _has_swerved(records: Array, *ticks: int) -> bool:
    """Return whether a move of one wheel turned the robot, and then a move of the other wheel turned it back.

    Args:
        records: The telemetry.
        ticks: Four ticks: the first tick of the first move and the tick after its last one, and the same for the second
            move.
    """
    start, end, next_start, next_end = ticks
    first, second = (
        records[max(0, low - 1) : high] for low, high in ((start, end), (next_start, next_end))
    )
    turned = [
        [float(np.ptp(way[f"{side}_position_deg"])) for side in _SIDES] for way in (first, second)
    ]
    movers = [int(np.argmax(angles)) for angles in turned]
    is_single = all(
        max(angles) >= _MIN_WHEEL_DEG and min(angles) <= _MAX_IDLE_SHARE * max(angles)
        for angles in turned
    )
    there, back = (
        float((way["heading_deg"][-1] - way["heading_deg"][0] + 180) % 360 - 180)
        for way in (first, second)
    )
    is_back = there * back < 0 and abs(there + back) <= _SAME_SHARE * abs(there)
    return is_single and movers[0] != movers[1] and is_back


def _list_moves(data: RunData, calls: Set[Call]) -> Iterator[_Move]:
    """Yield moves that were ended by the next command to the same motor or drive base, or by the end of the program.

    The moves are in the order of their ends.

    Args:
        data: The run.
        calls: The kinds of commands to consider.
    """
    aims = [call for call, words in CALL_WORDS.items() if words.aim is not Aim.NONE]
    is_aim = np.isin(data.commands["call"], aims)
    rows, ticks = (part[is_aim][:_MAX_COMMANDS] for part in (data.commands, data.command_ticks))
    last = len(data.records) - 1
    is_finished = data.is_finished and len(rows) == is_aim.sum()
    following: dict[tuple[bool, int], tuple[int, Call]] = {}
    all_moves: list[_Move] = []
    for row, tick in zip(rows[::-1], ticks[::-1].tolist(), strict=True):
        call = Call(int(row["call"]))
        part = (call >= Call.BUILD_BASE, int(row["part"]))
        end, next_call = following.get(part, (last, None))
        following[part] = tick, call
        if call in calls and (next_call or (is_finished and call not in _GO_ON)):
            all_moves.append(_Move(tick, end, call, row["values"].tolist(), part[1], next_call))
    yield from sorted(all_moves, key=lambda move: move.end)


def _find_call(data: RunData, move: _Move, fitting: list[UnwaitedMove]) -> UnwaitedMove | None:
    """Return the call in the program's text that gave the command of a move.

    The result is None if several calls may have given it, or if the program may have cut the move off on purpose.

    Args:
        data: The run.
        move: The move.
        fitting: The calls of this kind in the text that do not wait for the end of the move.
    """
    if move.next_call is None:
        ending = [each for each in fitting if not each.next_line]
        return ending[0] if len(ending) == 1 else None
    if move.end - move.tick > _AT_ONCE_S * data.hz and _has_looked(data, move):
        return None
    lines = {*data.records["line"][max(0, move.tick - 1) : move.end + 3].tolist()}
    calls = [each for each in fitting if lines & {*range(each.line, each.last_line + 1)}]
    following = [each for each in fitting if each.next_line in lines]
    if known := next((each for each in (*calls, *following) if each.next_line), None):
        return known
    calls = [each for each in calls if _turns_as_asked(data, move, each)] or calls
    is_at_once = move.end - move.tick <= _MAX_HARDLY and not _has_looked(data, move)
    return calls[0] if len(calls) == 1 and is_at_once else None


def _turns_as_asked(data: RunData, move: _Move, call: UnwaitedMove) -> bool:
    """Return whether a call in the text turns a motor by the same angle as a move."""
    turns = data.facts.find_turns(call.line)
    unit_deg = 360.0 if turns and turns[1] == "rotations" else 1.0
    return turns is not None and abs(turns[0]) * unit_deg == abs(move.values[1])


def _has_looked(data: RunData, move: _Move) -> bool:
    """Return whether the program probably ended a move on purpose.

    This is so if it read a sensor or motor during the move, or if the command that ended the move was a stop, or a
    start at a speed.
    """
    aim = CALL_WORDS[move.next_call].aim if move.next_call else Aim.NONE
    ticks = data.reading_ticks
    has_read = ((ticks >= move.tick) & (ticks <= move.end)).any()
    return bool(has_read) or aim is Aim.SPEED or move.next_call in STOP_CALLS


def _describe_share(data: RunData, move: _Move) -> str:
    """Return how much of a move was done when it was cut off, such as `of which 90 of 360 degrees were done`.

    The result is empty if most of it was done, if the move was short, or if its length is unknown.
    """
    values = move.values
    way = data.records[move.tick : move.end + 1]
    match move.call:
        case Call.RUN_UNTIL:
            asked, done, unit = (values[1] - move.tick) / data.hz, len(way) / data.hz, "s"
        case Call.RUN_TIMED:
            asked, done, unit = values[3] / 1000, len(way) / data.hz, "s"
        case Call.RUN_TO_REL_POS if move.part < len(_SIDES):
            turned_deg = np.ptp(way[f"{_SIDES[move.part]}_position_deg"])
            asked, done, unit = abs(values[1]), float(turned_deg), "degrees"
        case Call.MOVE_BASE if values[0]:
            steps_mm = np.hypot(np.diff(way["x_mm"]), np.diff(way["y_mm"]))
            asked, done, unit = abs(values[0]), float(steps_mm.sum()), "mm"
        case Call.MOVE_BASE:
            asked, done, unit = abs(values[1]), float(np.ptp(way["heading_deg"])), "degrees"
        case _:
            return "which had hardly begun" if len(way) <= _MAX_HARDLY else ""
    is_cut = math.isfinite(asked) and asked > _MIN_MOVE_S and done < _DONE_SHARE * asked
    return f"of which {done:.3g} of {asked:g} {unit} were done" if is_cut else ""
