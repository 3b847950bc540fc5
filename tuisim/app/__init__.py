"""The app: Textual screens, panels and dialogs over a run."""

__all__ = [
    "actions.keys",
    "analyser.app",
    "app",
]
