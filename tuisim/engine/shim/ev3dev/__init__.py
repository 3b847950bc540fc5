"""The libraries `ev3dev2` and `ev3dev` on the simulated brick: the published packages, patched when they are imported.

`modules` says what is done with which of their modules; `library` shortens the way from them to the devices.
"""
