"""The record of what a program did: written command by command, and read as far as it is there."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from tests.running import Run
from tuisim.base.errors import LogError
from tuisim.engine.core.commands.calls import MAX_VALUES, Call
from tuisim.engine.runs import command_records
from tuisim.engine.runs.command_records import COMMAND_RECORD, CommandsWriter, read_commands
from tuisim.engine.runs.records import COMMANDS_FILE, HEADER_BYTES

TURN = """\
from ev3dev2.motor import LargeMotor, OUTPUT_C
motor = LargeMotor(OUTPUT_C)
motor.position = 90
motor.on_for_degrees(20, 45)
"""


def test_every_command_can_be_read_at_once(tmp_path: Path) -> None:
    writer = CommandsWriter(tmp_path)
    assert not len(read_commands(tmp_path).rows)
    for count, call in enumerate(Call):
        writer.add(count * 1_000_003, count % 4, call, (0.5,) * (count % (MAX_VALUES + 1)))
    read = read_commands(tmp_path)
    for count, command in enumerate(read.unpack()):
        assert command[:3] == (count * 1_000_003, count % 4, list(Call)[count])
        given = count % (MAX_VALUES + 1)
        assert command.values == (0.5,) * given + (0.0,) * (MAX_VALUES - given)
    writer.close()
    size = HEADER_BYTES + len(Call) * COMMAND_RECORD.size
    assert (tmp_path / COMMANDS_FILE).stat().st_size == size


def test_a_flood_of_commands_is_counted_and_takes_no_more_space(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(command_records, "MAX_COMMANDS", 1000)
    writer = CommandsWriter(tmp_path)
    for count in range(1500):
        writer.add(count, 0, Call.STOP, ())
    writer.close()
    read = read_commands(tmp_path)
    assert (len(read.rows), read.left_out) == (1000, 500)
    assert (tmp_path / COMMANDS_FILE).stat().st_size == HEADER_BYTES + 1000 * COMMAND_RECORD.size


def test_a_damaged_record_is_named(tmp_path: Path) -> None:
    with pytest.raises(LogError, match="there is no record of what the program did"):
        read_commands(tmp_path)
    writer = CommandsWriter(tmp_path)
    writer.add(5, 0, 200, ())
    writer.close()
    with pytest.raises(ValueError, match="200"):
        list(read_commands(tmp_path).unpack())
    os.truncate(tmp_path / COMMANDS_FILE, HEADER_BYTES + 20)
    assert not len(read_commands(tmp_path).rows)
    os.truncate(tmp_path / COMMANDS_FILE, 5)
    with pytest.raises(LogError, match="too short"):
        read_commands(tmp_path)


def test_commands_of_a_program_are_recorded_in_order(run: Run) -> None:
    done = run(TURN, prelude="none")
    read = read_commands(done.run.folder)
    commands = [*read.unpack()]
    assert [command.call for command in commands] == [Call.SET_COUNT, Call.RUN_TO]
    assert {command.part for command in commands} == {1}
    assert commands[0].values[0] == 90.0
    assert commands[1].values[:3] == (135.0, 210.0, 0.0)
