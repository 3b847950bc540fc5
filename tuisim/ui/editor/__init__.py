"""The editor behind the code panel: its text, its file, its drafts, and what its keys do."""
