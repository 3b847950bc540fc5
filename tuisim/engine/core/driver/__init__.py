"""The motors of a brick under ev3dev: the motor itself, its counter, and its driver, as in kernel 4.14.

Speeds are degrees per second, angles degrees at the axle. All arithmetic of the driver is whole numbers, divided as in
C. Times are nanoseconds from the start of the run.
"""
