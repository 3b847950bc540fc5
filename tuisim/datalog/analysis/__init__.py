"""Analysis of logs: pure functions over arrays and frames, one file a subject."""
