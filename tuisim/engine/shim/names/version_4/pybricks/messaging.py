"""Messages between bricks."""
