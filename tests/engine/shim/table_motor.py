"""Checks of one motor and of speeds."""

from __future__ import annotations

from tests.engine.shim.checking import Check, Table


def _speed(name: str, argument: float, native: str, text: str, attribute: str) -> tuple[Check, ...]:
    ids = f"SpeedValue {name} {name}.__init__"
    return (
        Check(
            f"round({name}({argument}).to_native_units(m), 6)",
            native,
            f"{ids} {name}.to_native_units",
        ),
        Check(f"str({name}({argument}))", repr(text), f"{name}.__str__"),
        Check(
            f"{name}({argument}, 'x').desc, str({name}({argument}, 'x'))",
            "('x', 'x ')",
            f"{name}.desc",
        ),
        Check(f"type({name}({argument}) * 2).__name__", repr(name), f"{name}.__mul__"),
        Check(
            f"(2 * {name}({argument})).{attribute}",
            repr(2 * argument),
            f"SpeedValue.__rmul__ {name}.{attribute}",
        ),
        Check(f"{name}({argument}) * 'x'", "AssertionError"),
    )


SPEEDS = Table(
    "ev3dev2.motor",
    "from ev3dev2.motor import *\nfrom ev3dev2.motor import SpeedValue, speed_to_speedvalue\nm = LargeMotor(OUTPUT_B)",
    (
        *_speed("SpeedPercent", 5, "52.5", "5%", "percent"),
        *_speed("SpeedNativeUnits", 5, "5", "5.00 counts/sec", "native_counts"),
        *_speed("SpeedRPS", 1, "360.0", "1 rot/sec", "rotations_per_second"),
        *_speed("SpeedRPM", 60, "360.0", "60 rot/min", "rotations_per_minute"),
        *_speed("SpeedDPS", 90, "90.0", "90 deg/sec", "degrees_per_second"),
        *_speed("SpeedDPM", 60, "1.0", "60 deg/min", "degrees_per_minute"),
        Check("SpeedPercent(150)", "SpeedInvalid", "SpeedInvalid"),
        Check("SpeedPercent(60) * 2", "SpeedInvalid"),
        Check("issubclass(SpeedInvalid, ValueError)", "True", "SpeedInvalid"),
        Check("SpeedRPS(2.95).to_native_units(m)", "SpeedInvalid"),
        Check("SpeedRPS(2.9).to_native_units(m)", "1044.0"),
        Check("SpeedRPM(176).to_native_units(m)", "SpeedInvalid"),
        Check("SpeedDPS(1051).to_native_units(m)", "SpeedInvalid"),
        Check("SpeedDPM(63001).to_native_units(m)", "SpeedInvalid"),
        Check("SpeedNativeUnits(1051).to_native_units(m)", "SpeedInvalid"),
        *(
            Check(f"SpeedPercent(5) {sign} SpeedPercent(6)", "TypeError", f"SpeedValue.{name}")
            for sign, name in (
                ("==", "__eq__"),
                ("!=", "__ne__"),
                ("<", "__lt__"),
                ("<=", "__le__"),
                (">", "__gt__"),
                (">=", "__ge__"),
            )
        ),
        Check(
            "speed_to_speedvalue(7).percent, speed_to_speedvalue(SpeedRPS(1)).rotations_per_second",
            "(7, 1)",
            "speed_to_speedvalue",
        ),
        Check("speed_to_speedvalue(101)", "SpeedInvalid"),
        Check("speed_to_speedvalue('x')", "TypeError"),
    ),
)

MOTOR = Table(
    "ev3dev2.motor",
    "import time\nfrom ev3dev2 import motor\nfrom ev3dev2.motor import *\nm = LargeMotor(OUTPUT_B)",
    (
        Check(
            "OUTPUT_A, OUTPUT_B, OUTPUT_C, OUTPUT_D",
            repr(tuple(f"ev3-ports:out{port}" for port in "ABCD")),
            "OUTPUT_A OUTPUT_B OUTPUT_C OUTPUT_D",
        ),
        Check("motor.WAIT_RUNNING_TIMEOUT", "100", "WAIT_RUNNING_TIMEOUT"),
        Check(
            "m.address, m.driver_name, m.device_index",
            "('ev3-ports:outB', 'lego-ev3-l-motor', 1)",
            "LargeMotor LargeMotor.__init__ Motor.address Motor.driver_name ev3dev2:Device.device_index",
        ),
        Check(
            "Motor('outC').address, Motor(driver_name='lego-ev3-m-motor').address",
            "('ev3-ports:outC', 'ev3-ports:outA')",
            "Motor Motor.__init__",
        ),
        Check(
            "str(m), repr(m), str(LargeMotor())",
            "('LargeMotor(ev3-ports:outB)', 'LargeMotor(ev3-ports:outB)', 'LargeMotor')",
            "ev3dev2:Device.__str__ ev3dev2:Device.__repr__",
        ),
        Check("m.set_attr_string(None, 'state', 'x')", "PermissionError: [Errno 13] state"),
        Check("m.set_attr_string(None, 'nothing', 'x')", "DeviceNotFound"),
        Check(
            "MediumMotor(OUTPUT_A).max_speed, m.max_speed",
            "(1560, 1050)",
            "MediumMotor MediumMotor.__init__ Motor.max_speed",
        ),
        Check(
            "[round(x, 4) for x in (m.max_rps, m.max_rpm, m.max_dps, m.max_dpm)]",
            "[2.9167, 175.0, 1050.0, 63000.0]",
            "Motor.max_rps Motor.max_rpm Motor.max_dps Motor.max_dpm",
        ),
        Check("m.count_per_rot", "360", "Motor.count_per_rot"),
        Check("MediumMotor(OUTPUT_B)", "DeviceNotFound"),
        Check(
            "LargeMotor(OUTPUT_A)", "DeviceNotFound: LargeMotor(ev3-ports:outA) is not connected."
        ),
        Check("LargeMotor(OUTPUT_D).on_for_degrees(100, 720)"),
        Check("LargeMotor(OUTPUT_D).position", "720", "Motor.position"),
        Check(
            "m.commands",
            repr(
                [
                    "run-forever",
                    "run-to-abs-pos",
                    "run-to-rel-pos",
                    "run-timed",
                    "run-direct",
                    "stop",
                    "reset",
                ]
            ),
            "Motor.commands",
        ),
        Check(
            "m.commands == [m.COMMAND_RUN_FOREVER, m.COMMAND_RUN_TO_ABS_POS, m.COMMAND_RUN_TO_REL_POS, "
            "m.COMMAND_RUN_TIMED, m.COMMAND_RUN_DIRECT, m.COMMAND_STOP, m.COMMAND_RESET]",
            "True",
            "Motor.COMMAND_RUN_FOREVER Motor.COMMAND_RUN_TO_ABS_POS Motor.COMMAND_RUN_TO_REL_POS "
            "Motor.COMMAND_RUN_TIMED Motor.COMMAND_RUN_DIRECT Motor.COMMAND_STOP Motor.COMMAND_RESET",
        ),
        Check(
            "m.stop_actions == [m.STOP_ACTION_COAST, m.STOP_ACTION_BRAKE, m.STOP_ACTION_HOLD] "
            "== ['coast', 'brake', 'hold']",
            "True",
            "Motor.stop_actions Motor.STOP_ACTION_COAST Motor.STOP_ACTION_BRAKE Motor.STOP_ACTION_HOLD",
        ),
        Check(
            "[m.STATE_RUNNING, m.STATE_RAMPING, m.STATE_HOLDING, m.STATE_OVERLOADED, m.STATE_STALLED]",
            "['running', 'ramping', 'holding', 'overloaded', 'stalled']",
            "Motor.STATE_RUNNING Motor.STATE_RAMPING Motor.STATE_HOLDING Motor.STATE_OVERLOADED "
            "Motor.STATE_STALLED",
        ),
        Check(
            "m.POLARITY_NORMAL, m.POLARITY_INVERSED, m.polarity",
            "('normal', 'inversed', 'normal')",
            "Motor.POLARITY_NORMAL Motor.POLARITY_INVERSED Motor.polarity",
        ),
        Check("m.state, m.stop_action", "([], 'coast')", "Motor.state Motor.stop_action"),
        Check("m.command", "Exception"),
        # Set points.
        Check("m.speed_sp = 10.9; m.position_sp = -20; m.time_sp = 30; m.duty_cycle_sp = 40"),
        Check(
            "m.speed_sp, m.position_sp, m.time_sp, m.duty_cycle_sp",
            "(10, -20, 30, 40)",
            "Motor.speed_sp Motor.position_sp Motor.time_sp Motor.duty_cycle_sp",
        ),
        Check("m.ramp_up_sp = 60000; m.ramp_down_sp = 500"),
        Check(
            "m.ramp_up_sp, m.ramp_down_sp", "(60000, 500)", "Motor.ramp_up_sp Motor.ramp_down_sp"
        ),
        Check(
            "m.speed_sp = 1051",
            "ValueError: The given speed value 1051 was out of range. Max speed: +/-1050",
        ),
        Check("m.duty_cycle_sp = 101", "ValueError"),
        Check("m.time_sp = -1", "ValueError"),
        Check("m.ramp_up_sp = 60001", "ValueError"),
        Check("m.speed_p = -1", "ValueError"),
        Check("m.stop_action = 'fly'", "ValueError"),
        Check("m.polarity = 'odd'", "ValueError"),
        Check("m.command = 'jump'", "ValueError"),
        Check("m.count_per_rot = 1", "AttributeError"),
        Check("m.nonsense = 1", "AttributeError"),
        Check(
            "m.speed_p, m.speed_i, m.speed_d, m.position_p, m.position_i, m.position_d",
            "(1000, 60, 0, 80000, 0, 0)",
            "Motor.speed_p Motor.speed_i Motor.speed_d Motor.position_p Motor.position_i Motor.position_d",
        ),
        Check("MediumMotor().position_p", "160000"),
        Check("m.speed_p = 7; m.position_d = 8"),
        Check("m.reset()"),
        Check(
            "m.speed_sp, m.position_sp, m.time_sp, m.duty_cycle_sp, m.ramp_up_sp, m.ramp_down_sp, "
            "m.speed_p, m.position_d, m.stop_action",
            "(0, 0, 0, 0, 0, 0, 1000, 0, 'coast')",
            "Motor.reset",
        ),
        # Moves.
        Check(
            "m.on_for_degrees(50, 90), m.position, m.speed_sp, m.position_sp, m.state",
            "(None, 90, 525, 90, ['holding'])",
            "Motor.on_for_degrees",
        ),
        Check(
            "m.on_for_degrees(-50, 90, brake=False), m.position, m.speed_sp, m.position_sp, m.state",
            "(None, 0, 525, -90, [])",
        ),
        Check("m.on_for_degrees(-50, -90), m.position", "(None, 90)"),
        Check(
            "m.on_for_rotations(25, 2), m.position, m.rotations, m.degrees",
            "(None, 810, 2.25, 810.0)",
            "Motor.on_for_rotations Motor.rotations Motor.degrees",
        ),
        Check(
            "m.on_to_position(100, -10), m.position, m.speed_sp",
            "(None, -10, 1050)",
            "Motor.on_to_position",
        ),
        Check(
            "m.on_for_seconds(50, 2), m.position, m.time_sp",
            "(None, 1040, 2000)",
            "Motor.on_for_seconds",
        ),
        Check("m.on_for_seconds(50, -1)", "ValueError"),
        Check(
            "m.on(50), time.sleep(0.1), m.is_running, m.is_holding, m.speed, m.duty_cycle",
            "(None, None, True, False, 525, 50)",
            "Motor.on Motor.is_running Motor.is_holding Motor.speed Motor.duty_cycle",
        ),
        Check("m.speed_sp = 100; time.sleep(0.1)"),
        Check("m.speed", "525", "Motor.speed_sp"),
        Check(
            "m.off(), m.is_running, m.is_holding, m.speed",
            "(None, False, True, 0)",
            "Motor.off Motor.is_holding",
        ),
        Check("m.off(brake=False), m.state, m.stop_action", "(None, [], 'coast')"),
        Check("m.position = 1000"),
        Check(
            "m.run_to_abs_pos(position_sp=900, speed_sp=500), m.wait_while('running'), m.position",
            "(None, True, 900)",
            "Motor.run_to_abs_pos Motor.wait_while Motor.position",
        ),
        Check(
            "m.run_to_rel_pos(position_sp=50), m.wait_until_not_moving(), m.position",
            "(None, True, 950)",
            "Motor.run_to_rel_pos Motor.wait_until_not_moving Motor.position_sp",
        ),
        Check(
            "m.run_timed(time_sp=1000, stop_action='hold'), m.wait_until('holding'), m.position",
            "(None, True, 1450)",
            "Motor.run_timed Motor.wait_until Motor.time_sp",
        ),
        Check(
            "m.run_forever(speed_sp=100), m.wait(lambda state: 'stalled' in state, 500), m.stop(), m.state",
            "(None, False, None, ['holding'])",
            "Motor.run_forever Motor.wait Motor.stop Motor.stop_action",
        ),
        Check("m.run_forever(foo=1)", "AttributeError"),
        Check(
            "m.run_direct(duty_cycle_sp=20), time.sleep(0.1), m.speed",
            "(None, None, 210)",
            "Motor.run_direct",
        ),
        Check("m.duty_cycle_sp = -40; m.position_sp = -2**31"),
        Check("m.duty_cycle, m.position_sp", "(-40, -2147483648)"),
        Check("time.sleep(0.1)"),
        Check("m.speed, m.duty_cycle", "(-420, -40)", "Motor.duty_cycle_sp"),
        Check("m.command = m.COMMAND_STOP; m.polarity = 'inversed'; before = m.position"),
        Check(
            "m.on_for_degrees(50, 90), m.position - before",
            "(None, 90)",
            "Motor.command Motor.polarity",
        ),
        Check("m.polarity = 'normal'"),
        Check("-before - m.position", "90", "Motor.polarity"),
        # A chain of relative moves counts from goal to goal; one of no length is a stop.
        Check("m.on_for_degrees(50, 0), m.state", "(None, ['holding'])"),
        Check(
            "m.on_for_degrees(0, 100), m.state, m.is_stalled",
            "(None, ['running', 'stalled'], True)",
            "Motor.is_stalled",
        ),
        Check("m.is_overloaded, m.is_ramping", "(False, False)"),
        # Ramps.
        Check("m.reset(); m.ramp_up_sp = 1000; m.on(100); time.sleep(0.5)"),
        Check(
            "m.is_ramping, 515 < m.speed < 540, m.state",
            "(True, True, ['running', 'ramping'])",
            "Motor.is_ramping Motor.ramp_up_sp",
        ),
        Check("time.sleep(1); m.ramp_down_sp = 2000; m.off(); time.sleep(1)"),
        Check(
            "510 < m.speed < 540, m.state", "(True, ['running', 'ramping'])", "Motor.ramp_down_sp"
        ),
        Check("m.wait_until_not_moving(), m.state", "(True, ['holding'])"),
        # A duty cycle acts at once.
        Check("m.run_direct(duty_cycle_sp=50); m.duty_cycle_sp = -50; time.sleep(0.1)"),
        Check(
            "m.speed, m.state, m.stop(), m.wait_until_not_moving()",
            "(-525, ['running'], None, True)",
        ),
        Check("m.position = 0; t = time.time(); m.on_for_degrees(50, 720)"),
        Check("m.position, 1.3 < time.time() - t < 2.4", "(720, True)", "Motor.ramp_down_sp"),
        Check("list(motor.list_motors(address='outC'))[0].position", "0", "list_motors"),
    ),
)
