"""Charts and pictures, as text and as files. Without Textual."""
