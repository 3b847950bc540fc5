"""Dialogs: one file a subject."""
