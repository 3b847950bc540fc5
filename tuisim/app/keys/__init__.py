"""Displays of the keys: footer, command palette and help."""
