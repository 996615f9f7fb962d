"""Pictures, tables and ends of programs."""
