"""The editor behind the code panel: its text, file, drafts and keys."""
