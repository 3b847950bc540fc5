"""Runs that are over, packed: lossless, in a few bytes a tick."""
