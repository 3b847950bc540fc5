#!/usr/bin/env python3
import argparse
from ev3dev2.motor import MoveTank, MediumMotor

parser = argparse.ArgumentParser(description='drive')
parser.add_argument('--left', default='outA', help='port of the left motor')
parser.add_argument('--right', default='outD')
parser.add_argument('-m', '--medium-port', dest='medium', default='outB')
parser.add_argument('--speed', type=int, default=30)
args = parser.parse_args()
tank = MoveTank(args.left, args.right)
arm = MediumMotor(args.medium)
tank.on_for_rotations(args.speed, args.speed, 1)
print(args.speed, arm.address)
