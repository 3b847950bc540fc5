"""Every mission takes the robot and returns True when it thinks it worked."""
MISSIONS = {}


def mission(name):
    def register(func):
        MISSIONS[name] = func
        return func
    return register


@mission('1')
def push_the_crate(robot):
    d = robot.straight(500)
    robot.arm_to(120)
    robot.arm_to(-120)
    robot.straight(-500)
    return abs(d - 500) < 15


@mission('2')
def lift_the_bridge(robot):
    robot.lift_turns(3, wait=False)
    robot.straight(250)
    robot.lift.wait_until_not_moving(timeout=5000)
    robot.lift_turns(-3)
    return robot.lift.position < 10


@mission('3')
def turn_and_back(robot):
    robot.turn(90)
    print('   gyro says', 85 <= robot.gyro.angle <= 95)
    robot.turn(-90)
    return abs(robot.gyro.angle) <= 3
