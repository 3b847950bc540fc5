"""The analyser: a log as table, chart, bands and figures, with one cursor in time for all."""
