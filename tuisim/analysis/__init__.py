"""An open log that is analysed: cursor, selection, table, traces, events. Without Textual."""
