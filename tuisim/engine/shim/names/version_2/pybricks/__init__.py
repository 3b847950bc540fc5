"""The Pybricks library for the EV3."""
