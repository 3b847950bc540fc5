from ev3dev2.motor import MoveJoystick, OUTPUT_A, OUTPUT_C
joystick = MoveJoystick(OUTPUT_A, OUTPUT_C)
joystick.on(0, 60, 100)
joystick.off()
print('ok')
