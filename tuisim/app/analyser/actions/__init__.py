"""What the keys of the analyser do."""
