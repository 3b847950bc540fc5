from ev3dev2.motor import Motor, OUTPUT_A, OUTPUT_D
from ev3dev2.sensor import Sensor, INPUT_1
a, d = Motor(OUTPUT_A), Motor(OUTPUT_D)
probe = Sensor(INPUT_1, driver_name='lego-ev3-color')
probe.mode = 'COL-REFLECT'
a.run_timed(time_sp=200, speed_sp=100)
a.wait_while('running')
print(probe.value(0), d.count_per_rot)
