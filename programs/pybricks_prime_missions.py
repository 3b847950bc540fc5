"""Missions with a SPIKE Prime hub: menu, gyro, line, coloured crates (Pybricks)."""
# %sim_magic -b Harbour --press enter@1 --press enter@11 --press enter@31 --press enter@67
# K shows the hub. Without --press, press its buttons there: left or right, then the centre.

from pybricks.hubs import PrimeHub
from pybricks.parameters import Button, Color, Direction, Port
from pybricks.pupdevices import ColorSensor, Motor
from pybricks.robotics import DriveBase
from pybricks.tools import hub_menu, wait

# Black reads 5 and white 85: halfway between, the sensor is over the edge of the line.
EDGE = 45

hub = PrimeHub()
# The centre button chooses in the menu, so the Bluetooth button stops the program.
hub.system.set_stop_button(Button.BLUETOOTH)
arm = Motor(Port.D)
eye = ColorSensor(Port.C)
eye.detectable_colors([Color.RED, Color.YELLOW, Color.GREEN, Color.BLUE, Color.WHITE])
robot = DriveBase(
    Motor(Port.A, Direction.COUNTERCLOCKWISE), Motor(Port.B), wheel_diameter=56, axle_track=112
)
robot.settings(straight_speed=400, turn_rate=150)
robot.use_gyro(True)


def go_up(way):
    robot.straight(220)
    robot.turn(-90)
    robot.straight(way)


def come_back(way):
    robot.straight(-way)
    robot.turn(90)
    robot.straight(-220)


def wave():
    go_up(533)
    arm.run_angle(500, 90)
    arm.run_angle(500, -90)
    come_back(533)


def follow_line():
    robot.straight(290)
    # The further the sensor is from the edge, the faster the robot turns back to it.
    while eye.color() != Color.RED:
        robot.drive(150, 1.5 * (EDGE - eye.reflection()))
        wait(10)
    robot.stop()
    # On the line the robot has turned a little: the gyro knows how far.
    robot.turn(-13 - hub.imu.heading())
    robot.straight(-1713)
    robot.turn(13)


def sort_crates():
    go_up(823)
    robot.turn(90)
    start = robot.distance()
    robot.straight(330)
    red = 0
    for _ in range(6):
        robot.drive(200, 0)
        while eye.color() == Color.WHITE:
            wait(10)
        robot.straight(40)
        color = eye.color()
        print("Crate:", color)
        if color == Color.RED:
            red += 1
        # Red and yellow go to the left, green and blue to the right.
        arm.run_target(800, -90 if color in (Color.RED, Color.YELLOW) else 90)
        arm.run_target(800, 0)
        robot.straight(80)
    print("Red:", red)
    hub.display.number(red)
    robot.straight(start - robot.distance())
    robot.turn(-90)
    come_back(823)


missions = {1: wave, 2: follow_line, 3: sort_crates}
menu = [1, 2, 3, "X"]
while True:
    choice = hub_menu(*menu)
    if choice == "X":
        break
    hub.light.on(Color.ORANGE)
    missions[choice]()
    hub.light.on(Color.GREEN)
    print("Mission", choice, "done")
    # The next mission comes first in the menu.
    after = menu.index(choice) + 1
    menu = menu[after:] + menu[:after]
