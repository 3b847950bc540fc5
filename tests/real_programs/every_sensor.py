from ev3dev2.sensor.lego import ColorSensor, GyroSensor, TouchSensor, UltrasonicSensor
touch = TouchSensor('in1')
gyro = GyroSensor('in2')
color = ColorSensor('in3')
sonar = UltrasonicSensor('in4')
print(touch.is_pressed, gyro.angle, color.color_name, sonar.distance_centimeters > 50)
