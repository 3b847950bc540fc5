"""Dialogs: one file per subject."""
