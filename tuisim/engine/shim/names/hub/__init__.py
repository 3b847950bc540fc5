"""Pybricks 4 for SPIKE Prime and other hubs."""
