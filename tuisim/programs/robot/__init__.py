"""The robot that a program for a real brick talks about, read from its source.

`source` finds the program's own modules, `scopes` what its names stand for, `reach` what of it can run, `evaluation`
what an expression can be; `mentions` lists the devices that it makes, `wheels` and `assembly` build the robot from
them, and `report` says what was built.
"""
