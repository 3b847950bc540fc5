from ev3dev2.control.GyroBalancer import GyroBalancer


def main():
    robot = GyroBalancer()
    print('made')


if __name__ == '__main__' and False:
    main()
