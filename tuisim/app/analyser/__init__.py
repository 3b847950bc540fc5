"""The analyser as a screen: chart, table, bands and notes, with one cursor in time."""
