"""Commands: every change that a program makes to the simulation, as a value that can be recorded and repeated.

`calls` defines the kinds of commands, `table` what each does and which values it takes. Effects that the simulation
finds by itself are no commands: ends of moves, ramps and stalls. Neither is what a user does.
"""
