"""Motors that move when their program is over.

A brick's driver ends their moves, and lets their wheels come to rest; what has no end is stopped.
"""

from __future__ import annotations

from collections.abc import Collection

from tuisim.engine.core.driver.simulated import SimulatedMotor
from tuisim.engine.core.profile import NS_PER_S
from tuisim.engine.runtime.session import Session

MAX_REST_NS = NS_PER_S // 2
"""How long wheels may take to come to rest."""


def finish_moves(session: Session) -> str:
    """Let all moves end that are for a time or to a position; then let the wheels come to rest, unless a motor runs on.

    Returns:
        Which motors would turn on for ever, in words; empty for none, and for motors without a driver.

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
        # `advance`, not a wait of the scheduler: the program's threads are over.
        session.advance(session.now + NS_PER_S, True)
    turning = sorted(port for port, motor in motors.items() if motor.mode and motor.aim_dps)
    if not turning:
        _let_rest(session, motors.values())
        return ""
    *others, last = turning
    ports = f"{', '.join(others)} and {last}" if others else last
    return f"ended while {ports} {'were' if others else 'was'} still set to turn"


def _let_rest(session: Session, motors: Collection[SimulatedMotor]) -> None:
    """Let wheels roll out, or swing back to the position that they hold, within the time limit."""
    if all(motor.axle.stands for motor in motors):
        return
    end_ns = min(session.now + MAX_REST_NS, session.limits.time_ns or 1 << 62)
    while session.now < end_ns and not all(motor.resting for motor in motors):
        session.sim.line = 0
        session.advance(min(session.sim.compute_due_ns(session.sim.tick + 1), end_ns), True)
