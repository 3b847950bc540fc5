"""The module `evdev` as a program imports it: the brick's buttons, and the names that programs for gamepads use."""
