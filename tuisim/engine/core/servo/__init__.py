"""Servo motors: motors that follow trajectories, as the Pybricks firmware moves them.

`trajectory` computes the course of a motion, `settings` has the firmware's numbers, `control` follows one trajectory,
`motor` is the motor law, and `drive_base` moves two motors together.
"""
