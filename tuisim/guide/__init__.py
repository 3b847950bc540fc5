"""The guide: pages of Markdown, reference tables from the code, and search."""
