"""What every package may use: errors, data classes, files and folders, texts of programs; nothing of robots."""
