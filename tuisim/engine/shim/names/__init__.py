"""Libraries as an editor is to see them: modules under the names by which programs import them.

They are read, never run: the app looks names up in them, see `tuisim.app.editor.completion`.
"""
