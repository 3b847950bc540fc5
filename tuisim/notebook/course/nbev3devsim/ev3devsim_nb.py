"""Frames and pictures of what was logged, as `eds` has them."""

from tuisim.notebook.eds import get_dataframe_from_datalog, get_image_data_from_datalog

__all__ = ["get_dataframe_from_datalog", "get_image_data_from_datalog"]
