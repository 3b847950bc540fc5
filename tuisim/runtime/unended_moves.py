"""Motors that run on when their program is over: a brick's driver ends their moves, and what has no end is stopped."""

from __future__ import annotations

from tuisim.core.driver.simulated import SimulatedMotor
from tuisim.core.profile import NS_PER_S
from tuisim.runtime.session import Session


def finish_moves(session: Session) -> str:
    """Let all moves end that are for a time or to a position.

    Returns:
        Which motors would turn on for ever, in words; empty for none, and where no driver runs the motors.

    Raises:
        StopProgram: the time limit is reached, or the user stops the run.
    """
    sim = session.sim
    motors = {
        port: motor
        for port, motor in sim.motors_by_port.items()
        if isinstance(motor, SimulatedMotor)
    }
    if any(motor.ends_alone for motor in motors.values()):
        sim.line = 0
    while any(motor.ends_alone for motor in motors.values()):
        # Without the program's threads, which are over.
        session.advance(session.now + NS_PER_S, True)
    turning = sorted(port for port, motor in motors.items() if motor.mode and motor.aim_dps)
    if not turning:
        return ""
    *others, last = turning
    ports = f"{', '.join(others)} and {last}" if others else last
    return f"ended while {ports} {'were' if others else 'was'} still told to turn"
