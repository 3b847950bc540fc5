"""The app: Textual screens, panels and dialogs over a run."""
