"""Programs that mix sensors, threads and moves, to run under two models of the profile `nbev3devsim`."""

PROGRAMS = {
    "square with readings": """
for i in range(3):
    tank_drive.on_for_rotations(45, 45, 0.7)
    print(colorLeft.reflected_light_intensity, gyro.angle, get_clock())
    tank_turn.on_for_rotations(-100, 35, 1.68)
    print(gyro.angle)
""",
    "thread that reads while the robot drives": """
from threading import Thread
from time import sleep

def watch():
    for i in range(9):
        print(i, colorLeft.color, tank_drive.left_motor.position)
        sleep(0.07)

thread = Thread(target=watch)
thread.start()
tank_drive.on_for_seconds(55, 25, 0.9)
tank_drive.on_for_degrees(-25, -55, 200)
thread.join()
print(get_clock())
""",
    "one thread for each wheel": """
from threading import Thread
from ev3dev2.motor import LargeMotor

def turn(port, speed, degrees):
    motor = LargeMotor(port)
    motor.on_for_degrees(speed, degrees)
    print(degrees, motor.position, motor.speed)

threads = [Thread(target=turn, args=args) for args in ((OUTPUT_B, 35, 400), (OUTPUT_C, -65, 555.5))]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
print(tank_drive.left_motor.state, tank_drive.right_motor.state)
""",
    "thread that stops a move": """
from threading import Thread
from time import sleep

def stop():
    sleep(0.613)
    tank_drive.off()

Thread(target=stop).start()
tank_drive.on_for_rotations(70, 70, 9)
print(get_clock(), tank_drive.left_motor.position)
sleep(0.25)
tank_drive.on(-20, 30)
sleep(0.31)
""",
    "two threads that give commands": """
from threading import Thread
from time import sleep

def wiggle():
    for speed in (15, -45, 30, -5):
        tank_drive.left_motor.on(speed)
        sleep(0.13)

thread = Thread(target=wiggle)
thread.start()
for speed in (60, 10, -35):
    tank_drive.right_motor.on(speed)
    ultrasonic.distance_centimeters
    sleep(0.17)
thread.join()
tank_drive.off()
sleep(0.2)
""",
    "polling the encoder": """
tank_drive.on(42, 42)
while tank_drive.right_motor.position < 250:
    colorLeft.reflected_light_intensity
tank_drive.on_for_degrees(42, 21, 90)
print(tank_drive.left_motor.position, tank_drive.right_motor.position)
""",
    "forwards after backwards": """
from time import sleep
tank_drive.on(-65, -35)
sleep(0.8)
tank_drive.on_for_rotations(65, 35, 1.3)
tank_drive.on_for_rotations(-65, -35, 1.3)
print(tank_drive.left_motor.speed)
tank_drive.on(25, 25)
sleep(0.4)
""",
    "live set points": """
from time import sleep
from ev3dev2.motor import LargeMotor
m = LargeMotor(OUTPUT_C)
m.run_to_rel_pos(position_sp=700, speed_sp=333.9)
sleep(0.5)
m.position_sp = -3
sleep(0.21)
m.speed_sp = 90
sleep(0.4)
m.position_sp = 3.99
m.position = 12.7
sleep(0.6)
print(m.position, m.speed, m.state)
""",
    "set points after the end": """
from time import sleep
m = tank_drive.left_motor
m.on_for_degrees(40, 100)
m.position_sp = -5
sleep(0.3)
print(m.state, m.position)
m.speed_sp = 0
sleep(1.2)
m.position_sp = 5
m.position = -300
sleep(0.2)
m.speed_sp = 200
sleep(0.9)
print(m.state, m.position)
""",
    "polarity": """
from time import sleep
tank_drive.left_motor.polarity = "inversed"
tank_drive.on(35, 35)
sleep(0.7)
tank_drive.on_for_rotations(-35, 55, 0.6)
print(gyro.angle, tank_drive.left_motor.polarity)
tank_drive.left_motor.polarity = "normal"
tank_drive.on_for_seconds(35, 35, 0.33)
""",
    "swapped pair": """
pair = MoveTank(OUTPUT_C, OUTPUT_B)
pair.on_for_degrees(15, 75, 260)
print(get_clock())
pair.on_for_degrees(75, 15, 260)
print(get_clock())
MoveSteering(OUTPUT_C, OUTPUT_B).on_for_seconds(-35, 45, 0.45)
print(get_clock(), gyro.angle)
""",
    "units": """
from ev3dev2.motor import SpeedRPS, SpeedRPM, SpeedDPS, SpeedNativeUnits
from time import sleep
tank_drive.on(SpeedRPS(0.75), SpeedRPM(-41))
sleep(0.5)
tank_drive.on_for_rotations(SpeedDPS(123), SpeedNativeUnits(400), 0.9)
tank_drive.left_motor.on_for_degrees(SpeedPercent(-5), 33)
tank_drive.left_motor.on_for_degrees(-5, 33)
print(tank_drive.left_motor.speed)
""",
    "times between ticks": """
from time import sleep
for seconds in (0.011, 0.049, 0.333, 0.2005):
    tank_drive.on_for_seconds(33, -44, seconds)
    sleep(0.0123)
    print(get_clock(), gyro.angle)
""",
    "moves without blocking": """
from time import sleep
tank_drive.on_for_rotations(50, 80, 1, block=False)
for i in range(12):
    sleep(0.071)
    print(tank_drive.left_motor.state, tank_drive.right_motor.state, tank_drive.left_motor.position)
tank_drive.on_for_seconds(-30, -30, 0.4, block=False)
sleep(0.2)
tank_drive.on_for_rotations(20, 20, 0.5)
""",
    "waiting by hand": """
m = tank_drive.right_motor
m.on(30)
print(m.wait_until("running", 50), get_clock())
print(m.wait_until_not_moving(timeout=333), get_clock())
m.on_for_seconds(45, 0.37, block=False)
print(m.wait_while("running", 1000), get_clock(), gyro.angle)
m.off()
print(m.state, m.wait_until("running", 20), m.state)
""",
    "to positions": """
from ev3dev2.motor import LargeMotor
m = LargeMotor(OUTPUT_B)
for position in (150, 40, -60, 0, 80.9):
    m.on_to_position(55, position)
    print(m.position, m.speed, get_clock())
""",
    "nothing to do": """
tank_drive.on(60, 60)
colorLeft.color
tank_drive.on_for_rotations(50, 50, 0)
print(get_clock(), tank_drive.left_motor.position)
tank_drive.on_for_rotations(0, 45, 0.5)
tank_drive.on_for_seconds(20, 20, 0)
print(get_clock(), tank_drive.left_motor.position)
""",
    "duty cycle and faster than it can": """
from time import sleep
m = tank_drive.left_motor
m.run_forever(speed_sp=2000)
sleep(1.8)
print(m.speed)
m.run_direct(duty_cycle_sp=60)
sleep(0.6)
m.run_timed(speed_sp=-1500, time_sp=0.7)
sleep(1.5)
print(m.speed, m.position)
""",
    "pairs made anew": """
from time import sleep
tank_drive.on(45, 45)
sleep(0.5)
other = MoveSteering(OUTPUT_B, OUTPUT_C)
print(tank_drive.left_motor.state)
sleep(0.3)
print(tank_drive.left_motor.state, tank_drive.left_motor.speed)
other.on(45, 45)
sleep(0.35)
tank_drive.left_motor.reset()
sleep(0.25)
print(tank_drive.left_motor.position, gyro.angle)
""",
    "round and round": """
from time import sleep
tank_turn.on(100, 90)
sleep(3)
print(gyro.angle)
tank_turn.on(-100, 90)
sleep(5.5)
print(gyro.angle)
tank_turn.on_for_rotations(-80, 65, 3)
print(gyro.angle)
""",
}
