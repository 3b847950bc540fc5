"""Screens that come over the desk: pickers, dialogs, help."""
