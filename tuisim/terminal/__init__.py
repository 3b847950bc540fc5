"""The terminal kit: everything between an app of Textual and a terminal. It knows nothing of robots."""
