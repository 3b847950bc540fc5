#!/usr/bin/env python3
"""List everything on the ports, then the battery."""
from ev3dev2.motor import list_motors, OUTPUT_A, OUTPUT_B, OUTPUT_C, OUTPUT_D
from ev3dev2.sensor import list_sensors, INPUT_1, INPUT_2, INPUT_3, INPUT_4, Sensor
from ev3dev2.port import LegoPort
from ev3dev2.power import PowerSupply
from ev3dev2 import DeviceNotFound, get_current_platform

print('platform:', get_current_platform())

print('--- motors')
for m in list_motors():
    print(m.address, m.driver_name, 'max', m.max_speed, 'polarity', m.polarity, m.state)
    print('   ', ' '.join(m.commands))
    print('   ', ' '.join(m.stop_actions))

print('--- sensors')
for s in sorted(list_sensors(), key=lambda dev: dev.address):
    print(s.address, s.driver_name, s.mode, 'of', s.modes)
    print('    values:', [s.value(i) for i in range(s.num_values)], 'decimals', s.decimals, 'units', repr(s.units))

print('--- ports')
for addr in (INPUT_1, INPUT_2, INPUT_3, INPUT_4, OUTPUT_A, OUTPUT_B, OUTPUT_C, OUTPUT_D):
    try:
        p = LegoPort(addr)
        print(p.address, p.driver_name, p.mode, p.status)
    except DeviceNotFound as e:
        print('!!', e)

print('--- only gyros:', len(list(list_sensors(driver_name='lego-ev3-gyro'))))
try:
    any_sensor = Sensor(INPUT_2)
    print('generic in2:', any_sensor.driver_name)
except DeviceNotFound:
    print('generic in2: nothing')

batt = PowerSupply()
print('{:.1f} V between {:.1f} and {:.1f} V'.format(
    batt.measured_volts, batt.min_voltage / 1e6, batt.max_voltage / 1e6))
print('type', batt.type, batt.technology, 'current > 0:', batt.measured_amps > 0)
print('power plausible:', 1 < batt.measured_volts * 10 < 100)
