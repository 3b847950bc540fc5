"""Keys as they are shown: footer, command palette and help."""
