"""Checks of the battery and of the ports."""

from __future__ import annotations

from tests.engine.shim.checking import Check, Table, Tables, cases, check
from tests.engine.shim.conftest import RunOn

POWER = Table(
    "ev3dev2.power",
    "import time\nfrom ev3dev2.power import *\nfrom ev3dev2.motor import *\n"
    "p, tank = PowerSupply(), MoveTank(OUTPUT_B, OUTPUT_C)\n",
    (
        Check(
            "PowerSupply.SYSTEM_CLASS_NAME, PowerSupply.SYSTEM_DEVICE_NAME_CONVENTION",
            "('power_supply', '*')",
            "PowerSupply.SYSTEM_CLASS_NAME PowerSupply.SYSTEM_DEVICE_NAME_CONVENTION",
        ),
        Check(
            "p.technology, p.type",
            "('Li-ion', 'Battery')",
            "PowerSupply.technology PowerSupply.type",
        ),
        Check(
            "p.min_voltage, p.max_voltage",
            "(6000000, 8400000)",
            "PowerSupply.min_voltage PowerSupply.max_voltage",
        ),
        Check(
            "PowerSupply(name_pattern='lego-ev3-battery').type, str(p)",
            "('Battery', 'PowerSupply')",
            "PowerSupply PowerSupply.__init__",
        ),
        Check("PowerSupply('in1')", "DeviceNotFound: PowerSupply(in1) is not connected."),
        Check("p.measured_voltage = 1", "AttributeError"),
        Check(
            "p.measured_current, p.measured_amps",
            "(170000, 0.17)",
            "PowerSupply.measured_current PowerSupply.measured_amps",
        ),
        Check(
            "p.measured_voltage, p.measured_volts",
            "(8057500, 8.0575)",
            "PowerSupply.measured_voltage PowerSupply.measured_volts",
        ),
        # An hour of standing draws 170 mAh of 2050 mAh, over which the voltage falls by 2.1 V.
        Check("time.sleep(360), round(8.0575 - p.measured_volts, 4)", "(None, 0.0174)"),
        Check("tank.on(50, 100), time.sleep(0.1)", "(None, None)"),
        Check("round(p.measured_amps, 3), p.measured_volts < 8.0", "(0.47, True)"),
        Check("standing = p.measured_volts; time.sleep(360)"),
        Check("round(standing - p.measured_volts, 4)", "0.0481"),
        Check("tank.off(), p.measured_amps", "(None, 0.17)"),
    ),
)

PORT = Table(
    "ev3dev2.port",
    "from ev3dev2.port import *\na, b, t, u = (LegoPort(name) for name in ('outC', 'outD', 'in2', 'in1'))",
    (
        Check(
            "LegoPort.SYSTEM_CLASS_NAME, LegoPort.SYSTEM_DEVICE_NAME_CONVENTION",
            "('lego-port', '*')",
            "LegoPort.SYSTEM_CLASS_NAME LegoPort.SYSTEM_DEVICE_NAME_CONVENTION",
        ),
        Check(
            "[LegoPort(f'ev3-ports:in{n}').address for n in (1, 2, 3, 4)], str(t), LegoPort('outB').device_index",
            "(['ev3-ports:in1', 'ev3-ports:in2', 'ev3-ports:in3', 'ev3-ports:in4'], 'LegoPort(in2)', 5)",
            "LegoPort LegoPort.__init__ LegoPort.address",
        ),
        Check("LegoPort('in5')", "DeviceNotFound: LegoPort(in5) is not connected."),
        Check(
            "a.driver_name, t.driver_name",
            "('ev3-output-port', 'ev3-input-port')",
            "LegoPort.driver_name",
        ),
        Check(
            "a.modes, t.modes[-3:]",
            "(['auto', 'tacho-motor', 'dc-motor', 'led', 'raw'], ['ev3-uart', 'other-uart', 'raw'])",
            "LegoPort.modes",
        ),
        Check(
            "[LegoPort(n).status for n in ('outA', 'outC', 'in1', 'in2', 'in3', 'in4')]",
            "['tacho-motor', 'tacho-motor', 'ev3-uart', 'ev3-analog', 'ev3-uart', 'ev3-uart']",
            "LegoPort.status",
        ),
        Check("a.mode, a.status", "('auto', 'tacho-motor')"),
        Check("a.mode = 'sail'", "ValueError"),
        Check(
            "a.mode = 'led'",
            "NotSimulated: ev3dev2.port.LegoPort.mode: 'led' would disconnect lego-ev3-l-motor",
        ),
        Check("a.set_device = 'lego-ev3-l-motor'", "OSError"),
        Check("a.mode = 'tacho-motor'"),
        Check("a.mode, a.status", "('tacho-motor', 'tacho-motor')", "LegoPort.mode"),
        Check("a.set_device = 'lego-ev3-l-motor'"),
        Check(
            "a.set_device = 'lego-nxt-motor'",
            "NotSimulated: ev3dev2.port.LegoPort.set_device: the NXT motor (lego-nxt-motor) is not simulated",
            "LegoPort.set_device",
        ),
        Check("a.set_device", "Exception: set_device is a write-only property!"),
        Check("a.status = 'x'", "AttributeError"),
        Check("a.mode = 'auto'"),
        Check("a.mode", "'auto'"),
    ),
)

EMPTY_PORT = Table(
    "ev3dev2.port",
    "from ev3dev2.port import *\na, b = LegoPort('outA'), LegoPort('outD')",
    (
        Check("a.mode, a.status", "('auto', 'no-motor')"),
        Check(
            "a.mode = 'led'",
            "NotSimulated: ev3dev2.port.LegoPort.mode: a lamp on a motor port (led) is not",
        ),
        Check("a.mode = 'tacho-motor'"),
        Check("a.mode, a.status, b.mode", "('tacho-motor', 'tacho-motor', 'auto')"),
        Check(
            "a.set_device = 'rcx-led'",
            "NotSimulated: ev3dev2.port.LegoPort.set_device: a lamp on a motor port",
        ),
        Check(
            "a.set_device = 'lego-ev3-l-motor'",
            "NotSimulated: ev3dev2.port.LegoPort.set_device: nothing is plugged into",
        ),
    ),
)


TABLES: Tables = {
    "battery": (POWER, "plain", "empty"),
    "ports": (PORT, "eyes", "empty"),
    "empty ports": (EMPTY_PORT, "plain", "empty"),
}


@cases(TABLES)
def test_battery_and_ports_read_as_the_table_says(
    run_on: RunOn, table: Table, robot: str, world: str
) -> None:
    check(run_on, table, robot, world)
