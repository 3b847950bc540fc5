"""An open log that is analysed: cursor, selection, table, traces, events. Without Textual."""

__all__ = [
    "chart",
    "events",
    "model",
    "pins",
    "report",
    "source",
    "traces",
]
