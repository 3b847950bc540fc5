"""The guide: pages of Markdown, reference tables from the code, and search."""

__all__ = [
    "catalogue",
    "excerpt",
    "markdown",
    "search",
    "tables",
    "text",
]
