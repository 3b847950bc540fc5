"""What `tuisim log` does: one file a group of subcommands."""
