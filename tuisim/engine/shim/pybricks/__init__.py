"""The library `pybricks`, LEGO's own Python for the EV3, on the simulated brick.

Each module of the library is a module here, or a class of one; `modules` defines under which names a program finds
them. To add a part: write it in the module that is named like the library's, and name it in `modules`. Parts that are
not simulated are in `unsimulated`: a program can import them, and gets an error when it uses them.
"""
