"""Makes `import ev3dev2` in a program drive the simulated brick.

The genuine library runs unchanged; this package is to it what the kernel drivers are on
a real brick: devices with attributes, a platform, and a poll on motor state.
"""
