"""Logs: readers, columns, bands, signals, expressions, exports. Without Textual."""

__all__ = [
    "bands",
    "choices",
    "csv_cells",
    "derived",
    "export",
    "expressions",
    "frames",
    "levels",
    "log",
    "magnitude",
    "mcap_export",
    "plateaus",
    "preview",
    "reader",
    "signals",
    "table",
    "units",
]
