"""Commands: every change that a program makes to the simulation, as a value that can be recorded and given again.

`calls` says what there is, `table` what each call does and which values it takes. What follows by itself is no command:
ends of moves, ramps and stalls, which the simulation finds, and what a user does.
"""
