"""Pure drawing of the world, the brick and the debugger, without Textual."""
