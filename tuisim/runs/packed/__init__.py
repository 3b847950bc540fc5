"""Lossless compression of finished runs, to a few bytes per tick."""
