from ev3dev2.sensor.lego import UltrasonicSensor
front_us = UltrasonicSensor('in1')
left_us = UltrasonicSensor('in4')
print(round(front_us.distance_centimeters), round(left_us.distance_centimeters))
