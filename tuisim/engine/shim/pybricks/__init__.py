"""The library `pybricks`, LEGO's own Python for the EV3, on the simulated brick.

Each module of it is a module here, or a class of one; `modules` says under which names a program finds them. To add a
part: write it in the module that is named like the library's, and name it in `modules`. What is not simulated stands
in `unsimulated`: it can be imported, and says so when it is used.
"""
