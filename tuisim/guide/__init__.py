"""The guide: pages of Markdown, reference tables from the code, search, and the pages as HTML."""
