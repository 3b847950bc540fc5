"""The app: Textual widgets over the host."""
