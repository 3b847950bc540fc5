"""`python frozen_ticks.py TICKS`: print the CPU seconds and the seconds of ticks of a small simulation.

It does what the simulation of tuisim does in a tick: two motors on their ramps, the pose on its arc, a light sensor
over a mat, a record in a buffer, by objects and calls like there. It imports nothing of tuisim and is not to be
changed: the speeds of programs are told as a share of its speed.
"""

from __future__ import annotations

import math
import sys
import time
from struct import Struct

RECORD = Struct("<IIdddddfffHH")
ROOM = 4096
"""Records in the buffer, which is written again and again."""
WIDTH_MM, HEIGHT_MM, REACH_MM = 2362, 1143, 6
TICK_S = 0.01
RAMP_DPS = 50.0


class Motor:
    """A motor that approaches the speed it was told."""

    __slots__ = ("counting_dps", "position_deg", "wanted_dps")

    def __init__(self, wanted_dps: float) -> None:
        self.position_deg = self.counting_dps = 0.0
        self.wanted_dps = wanted_dps

    def step(self) -> float:
        """Run one tick and return the turn."""
        lacking = self.wanted_dps - self.counting_dps
        if lacking:
            self.counting_dps += min(max(lacking, -RAMP_DPS), RAMP_DPS)
        before = self.position_deg
        self.position_deg = before + self.counting_dps * TICK_S
        return self.position_deg - before


class Drive:
    """The pose of a robot."""

    __slots__ = ("heading_deg", "x_mm", "y_mm")

    def __init__(self) -> None:
        self.x_mm = 1000.0
        self.y_mm = 500.0
        self.heading_deg = 0.0

    def roll(self, left_deg: float, right_deg: float) -> None:
        """Apply the turns of both wheels."""
        left_mm, right_mm = left_deg * 0.4887, right_deg * 0.4887
        way_mm = (left_mm + right_mm) / 2
        turn = (right_mm - left_mm) / 180.0
        middle = math.radians(self.heading_deg) + turn / 2
        self.x_mm += way_mm * math.cos(middle)
        self.y_mm += way_mm * math.sin(middle)
        self.heading_deg += math.degrees(turn)


class Mat:
    """Grey bands that a sensor sees."""

    def __init__(self) -> None:
        row = bytes(255 if x // 100 % 2 else 80 for x in range(WIDTH_MM))
        self._pixels = row * HEIGHT_MM

    def mean(self, x_mm: float, y_mm: float) -> float:
        """Return the mean of a square."""
        left = int(x_mm) % (WIDTH_MM - REACH_MM)
        top = int(y_mm) % (HEIGHT_MM - REACH_MM)
        total = 0
        for row in range(top, top + REACH_MM):
            start = row * WIDTH_MM + left
            total += sum(self._pixels[start : start + REACH_MM])
        return total / (REACH_MM * REACH_MM)


class World:
    """All of it."""

    def __init__(self) -> None:
        self.left, self.right, self.drive, self.mat = Motor(200.0), Motor(210.0), Drive(), Mat()
        self.tick = 0
        self._buffer = bytearray(RECORD.size * ROOM)

    def tick_once(self) -> None:
        """Run one tick and record it."""
        self.drive.roll(self.left.step(), self.right.step())
        self.tick += 1
        left = self.left
        right = self.right
        drive = self.drive
        at = RECORD.size * (self.tick % ROOM)
        RECORD.pack_into(
            self._buffer,
            at,
            self.tick,
            1,
            drive.x_mm,
            drive.y_mm,
            drive.heading_deg,
            left.position_deg,
            right.position_deg,
            left.counting_dps,
            right.counting_dps,
            0.0,
            3,
            0,
        )

    def steer(self) -> None:
        """Read the light and tell the motors, as a program that follows a line."""
        turn = self.mat.mean(self.drive.x_mm, self.drive.y_mm) / 255 - 0.5
        self.left.wanted_dps = 200 + 100 * turn
        self.right.wanted_dps = 200 - 100 * turn


def drive(ticks: int) -> World:
    """Run ticks, with a reading before each tenth, and return the world after them."""
    world = World()
    for tick in range(ticks):
        if tick % 10 == 0:
            world.steer()
        world.tick_once()
    return world


if __name__ == "__main__":
    cpu_s, wall_s = time.process_time(), time.perf_counter()
    drive(int(sys.argv[1]))
    print(time.process_time() - cpu_s, time.perf_counter() - wall_s)
