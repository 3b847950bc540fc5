from ev3dev2.sensor import list_sensors


def main():
    for s in list_sensors():
        print(s.address, s.driver_name, s.mode, s.value())
