"""`Ev3devSensor` reads any sensor by the modes of its driver."""

from __future__ import annotations

from tests.engine.shim.conftest import RunOn

READ = """
from pybricks.ev3devices import UltrasonicSensor
from pybricks.iodevices import Ev3devSensor
from pybricks.parameters import Port
from pybricks.tools import StopWatch

eye, gyro = Ev3devSensor(Port.S1), Ev3devSensor(Port.S4)
print(eye.sensor_index, eye.port_index, gyro.sensor_index, gyro.port_index)
print(eye.read('US-DIST-CM') == (UltrasonicSensor(Port.S1).distance(),))
watch = StopWatch()
print(gyro.read('GYRO-G&A'), watch.time() >= 30)
watch.reset()
print(gyro.read('GYRO-G&A'), watch.time() < 30)
try:
    eye.read('NONSENSE')
except OSError as error:
    print(error.errno)
eye.read('COMPASS')
"""


def test_an_ev3dev_sensor_reads_any_mode_and_refuses_what_is_not_simulated(run_on: RunOn) -> None:
    done = run_on(READ, robot="eyes", profile="lego-micropython")
    assert done.lines == ["0 0 3 3", "True", "(0, 0) True", "(0, 0) True", "5"], done.errors
    assert done.ended.summary.startswith("NotSimulated: mode COMPASS on in1")
