import ev3dev.ev3 as ev3

left, right = ev3.LargeMotor(ev3.OUTPUT_C), ev3.LargeMotor(ev3.OUTPUT_D)
cs = ev3.ColorSensor(ev3.INPUT_4)
ir = ev3.InfraredSensor()
cs.mode = 'COL-REFLECT'
left.run_forever(speed_sp=100)
left.stop(stop_action='coast')
print(cs.value(), ir.value())
