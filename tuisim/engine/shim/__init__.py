"""Makes `import ev3dev2` in a program drive the simulated brick.

The genuine library runs unchanged; this package takes the place of the kernel drivers of
a real brick: devices with attributes, a platform, and polling of motor states.
"""
