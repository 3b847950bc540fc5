"""The libraries `ev3dev2` and `ev3dev` on the simulated brick: the published packages, patched when they are imported.

`modules` defines how each of their modules is patched; `library` shortens the way from them to the devices.
"""
