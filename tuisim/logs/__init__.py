"""Logs: readers, columns, bands, signals, expressions, exports. Without Textual."""
