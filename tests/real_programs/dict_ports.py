from ev3dev2.motor import LargeMotor, MediumMotor, MoveTank
from ev3dev2.sensor.lego import ColorSensor, GyroSensor

PORTS = {
    'left': 'outA',
    'right': 'outB',
    'attachment': 'outC',
    'color': 'in1',
    'gyro': 'in3',
}
tank = MoveTank(PORTS['left'], PORTS['right'])
attachment = MediumMotor(PORTS['attachment'])
color = ColorSensor(PORTS['color'])
gyro = GyroSensor(PORTS['gyro'])
tank.on_for_seconds(20, -20, 0.5)
print(gyro.angle > 3, color.reflected_light_intensity)
