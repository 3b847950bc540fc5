"""The layout of the panels."""
