"""Pybricks 2.0 for the EV3, with what version 1.0 had."""
