import ev3dev2
import ev3dev2.motor
import ev3dev2.sensor.lego
m = ev3dev2.motor.MediumMotor(ev3dev2.motor.OUTPUT_D)
t = ev3dev2.sensor.lego.TouchSensor('in3')
m.on_for_degrees(speed=20, degrees=60)
print(m.driver_name, t.is_released)
