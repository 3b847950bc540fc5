"""Commands about this installation: what the terminal and the machine offer, and the user's settings."""
