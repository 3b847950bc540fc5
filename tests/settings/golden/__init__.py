"""What settings and programs gave before, and what the outside sees of them."""
