"""The debugger: pauses a program at a line, an instant or an event, and inspects it. Loaded on first use."""
