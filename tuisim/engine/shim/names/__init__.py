"""Libraries as programs import them: modules under the names that programs use, in folders for versions of Pybricks.

Runs read the names of Pybricks from here, and the editor all of them: see `tuisim.app.editor.completion`.
"""
