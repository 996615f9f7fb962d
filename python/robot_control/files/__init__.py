"""Files that are read and written, and their errors."""
