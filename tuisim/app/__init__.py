"""The app: Textual screens, panels and dialogs over a run."""

import sys

# In Python 3.11 a parser fails in one thread if the limit changes in another. Jedi leaves one that is high enough.
sys.setrecursionlimit(max(sys.getrecursionlimit(), 3000))
