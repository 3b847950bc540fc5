"""The next run: what the user has chosen for it."""
