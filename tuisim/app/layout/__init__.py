"""Where panels go: the tree of the screen, the arrangements of panels, and how they are kept."""
