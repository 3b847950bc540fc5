"""Reports: a run or a log on one page."""
