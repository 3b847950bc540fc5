"""Pybricks 4 for the EV3."""
