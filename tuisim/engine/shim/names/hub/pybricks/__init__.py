"""The Pybricks library for hubs."""
