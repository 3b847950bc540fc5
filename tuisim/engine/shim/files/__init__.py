"""The brick's device files as a program finds them: `/sys/class`, the display's memory, the buttons."""
