from base import chassis, ahead, SpeedPercent


def main():
    ahead(20)
    chassis.on_for_degrees(SpeedPercent(25), SpeedPercent(-25), 290)
    chassis.on_for_degrees(SpeedPercent(-25), SpeedPercent(25), 290)
    ahead(-20)
