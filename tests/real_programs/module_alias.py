import ev3dev2.motor as motor
import ev3dev2.sensor as sensor
import ev3dev2.sensor.lego as lego

wheels = motor.MoveTank(motor.OUTPUT_B, motor.OUTPUT_D)
claw = motor.MediumMotor(motor.OUTPUT_A)
left_eye = lego.ColorSensor(sensor.INPUT_1)
right_eye = lego.ColorSensor(sensor.INPUT_4)
wheels.on_for_rotations(10, 10, 0.5)
print(left_eye.color_name, right_eye.color_name)
