"""What a run leaves behind: recording, the run store, frames, analysis, exports."""
