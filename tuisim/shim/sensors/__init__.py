"""Sensors as the kernel driver exposes them."""
