"""Sensors as the kernel driver has them."""
