"""Opening logs: stored runs and files of any format and size, also damaged ones."""

from tuisim.datalog.opening.layout import Layout
from tuisim.datalog.opening.loading import Loaded, loading, open_log
from tuisim.datalog.opening.log import Log, Series

__all__ = ["Layout", "Loaded", "Log", "Series", "loading", "open_log"]
