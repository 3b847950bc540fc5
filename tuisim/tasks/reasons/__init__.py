"""Where and why a run went wrong."""
