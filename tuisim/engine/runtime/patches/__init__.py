"""Replacements of Python's functions for programs: clocks, threads, signals, randomness, waits for files."""
