"""Tries to break tuisim: `python -m tests.proof [KIND…] [--minutes N] [--seed N]`."""
