from ev3dev2.motor import MediumMotor
grabber = MediumMotor('outA')
grabber.run_forever(speed_sp=-200)
grabber.wait_until('stalled')
grabber.stop()
print('closed', grabber.position < 0)
grabber.run_to_rel_pos(position_sp=90, speed_sp=300)
grabber.wait_while('running')
print('open')
