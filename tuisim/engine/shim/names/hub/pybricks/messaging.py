"""Messages between hubs."""
