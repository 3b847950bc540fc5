"""Batches: one program, or several, over many seeds and settings."""
