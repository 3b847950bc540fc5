"""Packed recordings come back to the last bit, whatever they hold, and however packing them ends."""

from __future__ import annotations

import itertools
import os
import random
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.core.motors import COMMANDED, SERVO, commanded, run
from tuisim.core.geometry import Pose
from tuisim.core.profile import PROFILES
from tuisim.core.servo.control import Ending
from tuisim.core.servo.motor import ServoMotor
from tuisim.core.simulation import Simulation
from tuisim.core.spec import NoiseSpec, RobotSpec, RunSpec, WorldSpec
from tuisim.errors import LogError
from tuisim.runs import packed_codec
from tuisim.runs.packed_codec import TICK
from tuisim.runs.packed_files import PACKED_SUFFIX, compact
from tuisim.runs.records import (
    HEADER_BYTES,
    OUTPUT_FILE,
    TELEMETRY_FILE,
    OutputWriter,
    Stream,
    TelemetryWriter,
)
from tuisim.runs.views import OutputView, TelemetryView

SPEC = RunSpec(RobotSpec(), WorldSpec(), PROFILES["robolab"])


def _straight(sim: Simulation) -> None:
    commanded(sim.left).run(213.15)
    commanded(sim.right).run(213.15)
    sim.advance(2000)


def _curves(sim: Simulation) -> None:
    for turn in range(20):
        commanded(sim.left).run(100.0 / (turn + 1))
        commanded(sim.right).run(77.7 * (turn - 9))
        sim.advance(97)


def _steered(sim: Simulation) -> None:
    chance = random.Random(1)
    for _ in range(1000):
        commanded(sim.left).run(chance.uniform(-500, 500))
        commanded(sim.right).run(chance.uniform(-500, 500))
        sim.advance(2)


def _moves(sim: Simulation) -> None:
    for _ in range(10):
        commanded(sim.left).run_to(sim.left.position_deg + 365.25, 300.0, False)
        commanded(sim.right).run_to(sim.right.position_deg - 200.0, 250.0, True)
        sim.advance(150)
        commanded(sim.left).run_until(-250.0, sim.tick + 40)
        sim.advance(60)


def _moved_by_hand(sim: Simulation) -> None:
    for turn in range(10):
        sim.line = turn
        commanded(sim.left).run(315.0)
        commanded(sim.right).run(105.0)
        sim.advance(50)
        sim.place(Pose(100.0 * turn, -1e9 if turn == 5 else 3.25, 1e7 if turn == 6 else -0.0))
        sim.left.position_deg = 0.0
        sim.actions += 1
        sim.reset_gyro()
        sim.rewrite_record()


def _followed(sim: Simulation) -> None:
    chance = random.Random(2)
    for turn in range(40):
        for motor in (sim.left, sim.right):
            assert isinstance(motor, ServoMotor)
            now_us = sim.tick * 1_000_000 // sim.spec.profile.tick_hz
            if turn % 3:
                run(sim, motor, chance.uniform(-800, 800))
            else:
                motor.control.move_to(
                    now_us, motor.measured, chance.randrange(-900, 900), 1000, 3200, relative=True
                )
                motor.follow(ending=Ending(turn % 2))
        sim.advance(chance.choice((1, 7, 150)))


WAYS = {
    "straight": _straight,
    "curves": _curves,
    "steered": _steered,
    "moves": _moves,
    "by hand": _moved_by_hand,
}
SERVO_WAYS = {"followed": _followed}
MOST_BYTES = {"straight": 3.0, "curves": 15.0, "steered": 25.0, "moves": 15.0, "by hand": 15.0}
"""A tick, without noise; short recordings, in which the first of everything weighs more."""


def _recorded(folder: Path, way: str, profile: str = "robolab", noise: int = 0) -> None:
    folder.mkdir()
    spec = RunSpec(RobotSpec(), WorldSpec(noise=NoiseSpec(0, noise)), PROFILES[profile], 5)
    writer = TelemetryWriter(folder)
    (WAYS | SERVO_WAYS)[way](Simulation(spec, writer))
    writer.close()
    output = OutputWriter(folder)
    for row in range(300):
        output.write(
            f"Größe: {row % 7}".encode() * (row % 3),
            row // 2,
            row * 7_000_000,
            row % 5,
            Stream.STDOUT,
        )
    output.close()


@pytest.mark.quick_cases("*-robolab-*")
@pytest.mark.parametrize("noise", [0, 50], ids=["quiet", "noisy"])
@pytest.mark.parametrize(
    ("way", "profile"), [*itertools.product(WAYS, COMMANDED), *itertools.product(SERVO_WAYS, SERVO)]
)
def test_every_bit_comes_back(tmp_path: Path, way: str, profile: str, noise: int) -> None:
    folder = tmp_path / "run"
    _recorded(folder, way, profile, noise)
    telemetry, output = TelemetryView(folder).array().tobytes(), OutputView(folder).all_rows()
    compact(folder)
    assert sorted(path.name for path in folder.iterdir()) == [
        name + PACKED_SUFFIX for name in (OUTPUT_FILE, TELEMETRY_FILE)
    ]
    again = TelemetryView(folder)
    assert again.last() == again.record(again.count - 1)
    assert again.array().tobytes() == telemetry
    assert OutputView(folder).all_rows() == output
    if not noise and profile == "robolab":
        bytes_a_tick = (folder / (TELEMETRY_FILE + PACKED_SUFFIX)).stat().st_size / again.count
        assert bytes_a_tick < MOST_BYTES[way]


def test_rows_in_several_pieces(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(packed_codec, "ROWS_AT_ONCE", 7)
    _recorded(tmp_path / "run", "moves")
    data = (tmp_path / "run" / OUTPUT_FILE).read_bytes()[HEADER_BYTES:]
    assert packed_codec.unfold_rows(packed_codec.fold_rows(data)) == data
    with pytest.raises(ValueError, match="incomplete"):
        packed_codec.fold_rows(data[:-1])


def test_a_reader_that_was_there_before_goes_on(tmp_path: Path) -> None:
    folder = tmp_path / "run"
    folder.mkdir()
    writer = TelemetryWriter(folder)
    sim = Simulation(SPEC, writer)
    view = TelemetryView(folder)
    assert view.count == 1
    commanded(sim.left).run(100.0)
    # More than the reader's map holds.
    sim.advance(20_000)
    writer.close()
    whole = TelemetryView(folder).array().tobytes()
    compact(folder)
    assert view.count == 20_001
    assert view.array().tobytes() == whole


class Killed(BaseException):
    """Stands for the end of the process."""


@pytest.mark.parametrize("step", range(1, 9))
def test_packing_may_be_cut_off_anywhere(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, step: int
) -> None:
    folder = tmp_path / "run"
    _recorded(folder, "curves")
    telemetry, output = TelemetryView(folder).array().tobytes(), OutputView(folder).all_rows()
    done = 0

    def counted(real: Callable[..., object]) -> Callable[..., object]:
        def act(*arguments: object, **named: object) -> object:
            nonlocal done
            done += 1
            if done == step:
                raise Killed
            return real(*arguments, **named)

        return act

    with monkeypatch.context() as patch:
        for module, name in ((os, "fsync"), (os, "replace"), (Path, "unlink")):
            patch.setattr(module, name, counted(getattr(module, name)))
        if step <= 2:
            with pytest.raises(Killed):
                compact(folder)
        else:
            # Past the last step nothing is cut off.
            try:
                compact(folder)
            except Killed:
                assert step <= done
    assert TelemetryView(folder).array().tobytes() == telemetry
    assert OutputView(folder).all_rows() == output
    compact(folder)
    assert TelemetryView(folder).array().tobytes() == telemetry
    assert OutputView(folder).all_rows() == output
    assert not (folder / TELEMETRY_FILE).exists()


def _flip(data: bytes, at: int) -> bytes:
    return data[:at] + bytes([data[at] ^ 0x10]) + data[at + 1 :]


DAMAGES: dict[str, tuple[Callable[[bytes], bytes], str]] = {
    "magic": (lambda data: _flip(data, 2), "not a packed recording"),
    "version": (lambda data: _flip(data, 8), "format version 18, this tuisim reads 2"),
    "header": (lambda data: _flip(data, 90), "header is corrupt"),
    "content": (lambda data: _flip(data, len(data) - 30), "damaged"),
    "cut": (lambda data: data[:-1], "damaged"),
    "long": (lambda data: data + b"x", "damaged"),
    "short": (lambda data: data[:20], "too short"),
    "empty": (lambda data: b"", "too short"),
}


@pytest.mark.parametrize("damage", DAMAGES)
@pytest.mark.parametrize("name", [TELEMETRY_FILE, OUTPUT_FILE])
def test_damage_is_told_and_loses_nothing_else(tmp_path: Path, name: str, damage: str) -> None:
    folder = tmp_path / "run"
    _recorded(folder, "moves")
    compact(folder)
    path = folder / (name + PACKED_SUFFIX)
    change, told = DAMAGES[damage]
    path.write_bytes(change(path.read_bytes()))
    with pytest.raises(LogError, match=rf"{name}\.packed: .*{told}"):
        TelemetryView(folder).array()
        OutputView(folder).all_rows()
    other = (
        OutputView(folder).length if name == TELEMETRY_FILE else len(TelemetryView(folder).array())
    )
    assert other > 300


def test_any_flipped_byte_is_noticed_unless_it_changes_nothing(tmp_path: Path) -> None:
    folder = tmp_path / "run"
    _recorded(folder, "curves")
    telemetry = TelemetryView(folder).array().tobytes()
    compact(folder)
    path = folder / (TELEMETRY_FILE + PACKED_SUFFIX)
    data, noticed = path.read_bytes(), 0
    for at in random.Random(2).sample(range(len(data)), 200):
        path.write_bytes(_flip(data, at))
        try:
            # Some bits of compressed data mean nothing.
            assert TelemetryView(folder).array().tobytes() == telemetry
        except LogError:
            noticed += 1
    assert noticed > 190


def test_a_recording_without_its_end_stays(tmp_path: Path) -> None:
    folder = tmp_path / "run"
    _recorded(folder, "straight")
    path = folder / TELEMETRY_FILE
    os.truncate(path, path.stat().st_size - 100)
    note = TelemetryView(folder).note
    compact(folder)
    assert note and TelemetryView(folder).note == note


def test_left_over_files_go_when_they_are_old(tmp_path: Path) -> None:
    folder = tmp_path / "run"
    _recorded(folder, "straight")
    old, new = (folder / f".{TELEMETRY_FILE}{PACKED_SUFFIX}.{name}.tmp" for name in ("old", "new"))
    old.touch()
    new.touch()
    os.utime(old, (0, 0))
    compact(folder)
    assert not old.exists() and new.exists()


def test_what_would_not_come_back_is_not_packed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "run"
    _recorded(folder, "curves")
    kept = tmp_path / "kept"
    shutil.copytree(folder, kept)
    monkeypatch.setattr(packed_codec, "unfold_ticks", lambda *_: bytes(TICK.itemsize))
    with pytest.raises(LogError, match="without loss"):
        compact(folder)
    assert (folder / TELEMETRY_FILE).read_bytes() == (kept / TELEMETRY_FILE).read_bytes()
