"""The effects of user actions on the simulation. Pure Python, because the child imports it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tuisim.engine import protocol
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.sensors.touch import find_hand_flags
from tuisim.engine.core.spec import NoiseSpec

if TYPE_CHECKING:
    from tuisim.engine.core.simulation import Simulation
    from tuisim.engine.protocol import Message


def change_simulation(sim: Simulation, action: Message) -> None:
    """Apply a user's action to a simulation right before the next tick, and count it in `sim.actions`.

    Answers to a program change nothing but this number.

    Raises:
        TypeError: the message is not a user action.
    """
    match action:
        case protocol.SetPose(x_mm=x, y_mm=y, heading_deg=heading):
            sim.place(Pose(x, y, heading))
        case protocol.SetNoise(light=light, motor=motor):
            sim.noise = NoiseSpec(light, motor)
        case protocol.SetPen(down=down):
            sim.pen_down = down
        case protocol.SetButtons(pressed=pressed):
            sim.press(find_hand_flags(frozenset(pressed)))
        case protocol.Answer() | protocol.Reply():
            pass
        case _:
            raise TypeError(f"not a user action: {action!r}")
    sim.actions += 1
    sim.update_record()
